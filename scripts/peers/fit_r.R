# data.table and minpack.lm: both laws by nlsLM. usage: Rscript fit_r.R TRACE.csv
suppressPackageStartupMessages({
  library(data.table)
  library(minpack.lm)
})

omega_r <- 4 * 2 * pi / 60 * 15 # disc at the friction radius [mm/s]: 4 rpm, 15 mm
trace <- fread(commandArgs(trailingOnly = TRUE)[1], showProgress = FALSE)
relative_velocity <- omega_r - trace$v_b_mm_s
speed <- abs(relative_velocity)
noise <- 1.4826 * median(speed[speed < 0.1 * max(speed)])
slips <- speed > 8 * noise
v <- speed[slips]
mu <- (trace$mu * sign(relative_velocity))[slips]

start <- list(mu_s = max(mu), mu_k = min(mu), decay = 3 / max(v))
print(summary(nlsLM(mu ~ mu_k + (mu_s - mu_k) * exp(-decay * v), start = start)))
print(summary(nlsLM(mu ~ mu_k + (mu_s - mu_k) / (1 + decay * v), start = start)))

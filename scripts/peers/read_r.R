# data.table only reads the trace. usage: Rscript read_r.R TRACE.csv
suppressPackageStartupMessages(library(data.table))
trace <- fread(commandArgs(trailingOnly = TRUE)[1], showProgress = FALSE)
cat(nrow(trace), "rows\n")

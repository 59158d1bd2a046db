"""pandas and SciPy: both laws by curve_fit. usage: fit_scipy.py TRACE.csv"""

import sys

import numpy as np
from scipy.optimize import curve_fit
from slip import exponential, fractional, slip_samples, starts

speed, friction = slip_samples(sys.argv[1])
for law in (exponential, fractional):
    values, covariance = curve_fit(law, speed, friction, starts(speed, friction))
    rmse = np.sqrt(np.mean((law(speed, *values) - friction) ** 2))
    print(f"{law.__name__:12} mu_s {values[0]:.5f} mu_k {values[1]:.5f} decay {values[2]:.6f} s/mm rmse {rmse:.6f}",
          np.sqrt(np.diag(covariance)))

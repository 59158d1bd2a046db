"""pandas and lmfit: both laws by Model.fit. usage: fit_lmfit.py TRACE.csv"""

import sys

from lmfit import Model
from slip import exponential, fractional, slip_samples, starts

speed, friction = slip_samples(sys.argv[1])
mu_s, mu_k, decay = starts(speed, friction)
for law, name in ((exponential, "alpha"), (fractional, "beta")):
    result = Model(law).fit(friction, v=speed, mu_s=mu_s, mu_k=mu_k, **{name: decay})
    print(result.fit_report())

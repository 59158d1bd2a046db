"""Baseline of the benchmark of hidden effects: each effect alone beside each of two laws by scipy.optimize.curve_fit; the
least AIC is named where it is ten below that of the bare law. Every sample counts as one observation, as is usual.
usage: benchmark_aic.py RECORDS ANSWERS.jsonl"""

import sys
import warnings

import numpy as np
from benchmark_records import records, write
from scipy.optimize import curve_fit

LEAST_GAIN = 10


def exponential(v, p, power=1.0):
    return p[1] + (p[0] - p[1]) * np.exp(-((np.abs(p[2]) * v) ** power))


def fractional(v, p, power=1.0):
    return p[1] + (p[0] - p[1]) / (1 + (np.abs(p[2]) * v) ** power)


def swing(s, p, order=1):
    return p[0] * np.cos(order * s.angle) + p[1] * np.sin(order * s.angle)


def slope(f, s, p):
    h = 1e-3 * (1 + s.v)
    return (f(s.v + h, p) - f(s.v, p)) / h


# Name, starts, model(law, samples, parameters of the law, own), parameters to report (name, place), what must vary.
EFFECTS = [
    ("viscous", [0.0], lambda f, s, p, q: f(s.v, p) + q[0] * s.v, [("sigma", 0)], "v"),
    ("stribeck-exponent", [1.0], lambda f, s, p, q: f(s.v, p, np.clip(q[0], 0.2, 4)), [("delta", 0)], "v"),
    ("frictional-lag", [0.5], lambda f, s, p, q: f(s.v, p) - 1e-3 * q[0] * slope(f, s, p) * s.rate, [("tau", 0)], "rate"),
    ("channel-delay", [0.5], lambda f, s, p, q: f(np.abs(s.v - 1e-3 * q[0] * s.rate), p), [("delay", 0)], "rate"),
    ("asymmetry", [1.0], lambda f, s, p, q: f(s.v, p) * np.where(s.direction < 0, q[0], 1), [("ratio", 0)], "direction"),
    ("heating", [0.0, 5.0], lambda f, s, p, q: f(s.v, p) * (1 - q[0] * (1 - np.exp(-s.time / max(abs(q[1]), 0.1)))),
     [("h", 0), ("tau_h", 1)], "time"),
    ("run-in", [0.0, 100.0], lambda f, s, p, q: f(s.v, p) * (1 + q[0] * np.exp(-s.distance / max(abs(q[1]), 1))),
     [("w", 0), ("L", 1)], "distance"),
    ("drift", [0.0], lambda f, s, p, q: f(s.v, p) * (1 + q[0] * s.time), [("d", 0)], "time"),
    ("load-dependence", [0.0], lambda f, s, p, q: f(s.v, p) * s.load ** -q[0], [("p", 0)], "load"),
    ("temperature-dependence", [0.0], lambda f, s, p, q: f(s.v, p) * (1 + q[0] * s.temperature), [("k_T", 0)], "temperature"),
    ("runout", [0.0, 0.0], lambda f, s, p, q: f(s.v, p) * (1 + swing(s, q)), [("A", None)], "angle"),
    ("disc-pattern", [0.0, 0.0, 0.0, 0.0],
     lambda f, s, p, q: f(s.v, p) * (1 + swing(s, q[:2], 2) + swing(s, q[2:], 3)), [("A_2", None)], "angle"),
    ("sensor-inertia", [0.0], lambda f, s, p, q: f(s.v, p) + 1e-3 * q[0] * s.rate / s.newton, [("m_s", 0)], "rate"),
    ("sensor-offset", [0.0], lambda f, s, p, q: f(s.v, p) + q[0] * s.direction, [("b", 0)], "direction"),
    ("crosstalk", [0.0], lambda f, s, p, q: f(s.v, p) + q[0] * s.load * s.direction, [("chi", 0)], "load"),
]


def fit(model, starts, s):
    """Parameters, standard errors, root mean square left and AIC; nothing where it does not converge."""
    try:
        values, covariance = curve_fit(lambda _, *p: model(np.array(p)), s.v, s.mu, starts, maxfev=300 * len(starts))
    except (RuntimeError, ValueError, FloatingPointError):
        return None
    rmse = np.sqrt(np.mean((model(values) - s.mu) ** 2))
    if not np.isfinite(rmse) or rmse == 0:
        return None
    return values, np.sqrt(np.diag(covariance)), rmse, len(s) * np.log(rmse**2) + 2 * len(starts)


def parameters_of(reported, values, errors):
    out = {}
    for name, place in reported:
        if place is None:
            out[name] = {"value": float(np.hypot(values[0], values[1]))}
            continue
        half = 1.96 * errors[place]
        out[name] = {"value": float(values[place])}
        if np.isfinite(half):
            out[name]["ci95"] = [float(values[place] - half), float(values[place] + half)]
    return out


def answer(record, s):
    best = None
    for f in (exponential, fractional):
        starts = [s.mu.max(), s.mu.min(), 3 / s.v.max()]
        bare = fit(lambda p, f=f: f(s.v, p), starts, s)
        if bare and (best is None or bare[3] < best[0]):
            best = (bare[3], None, bare)
    bare_aic = best[0] if best else np.inf
    for f in (exponential, fractional):
        starts = [s.mu.max(), s.mu.min(), 3 / s.v.max()]
        for name, own, model, reported, channel in EFFECTS:
            if np.ptp(getattr(s, channel)) == 0:
                continue
            found = fit(lambda p, f=f, model=model: model(f, s, p[:3], p[3:]), [*starts, *own], s)
            if found and found[3] < min(best[0] if best else np.inf, bare_aic - LEAST_GAIN):
                best = (found[3], (name, reported), found)
    out = {"record": record, "effects": []}
    if best is None:
        return out
    values, errors, rmse, _ = best[2]
    out["error_left"] = float(rmse)
    if best[1]:
        name, reported = best[1]
        out["effects"] = [{"effect": name, "parameters": parameters_of(reported, values[3:], errors[3:])}]
    return out


warnings.simplefilter("ignore")
np.seterr(all="ignore")
write((answer(record, s) for record, s in records(sys.argv[1])), sys.argv[2])

"""Baseline of the benchmark of hidden effects: sparse regression on a library of terms by sequentially thresholded least
squares (Brunton, Proctor and Kutz 2016). The base law is a sum of exponentials of speed, which is always kept; every other
term stands for an effect, and what survives is named. A term survives that moves friction by more than the threshold,
which is the highest of a list that leaves within a hundredth of the least on every fifth hundredth of the record.
usage: benchmark_sparse.py RECORDS ANSWERS.jsonl"""

import sys

import numpy as np
from benchmark_records import records, write

THRESHOLDS = (0.002, 0.004, 0.008, 0.016, 0.032)  # of mu, as a root mean square over the record
ROUNDS = 10
MOST_WORSE = 1.01


def law_terms(s):
    top = s.v.max()
    return [np.ones(len(s))] + [np.exp(-s.v / (top * part)) for part in (0.05, 0.1, 0.2, 0.4, 0.8)]


def effect_terms(s):
    """(effect, parameter that the coefficient is, term)."""
    base = s.mu.mean()
    share = s.time / max(np.ptp(s.time), 1e-9)
    slid = s.distance / max(np.ptp(s.distance), 1e-9)
    terms = [("viscous", "sigma", s.v), ("frictional-lag", None, s.rate / max(np.ptp(s.rate), 1e-9)),
             ("sensor-inertia", None, s.acceleration / max(np.ptp(s.acceleration), 1e-9) * s.direction),
             ("drift", "d", base * s.time), ("heating", None, np.exp(-4 * share)), ("run-in", None, np.exp(-4 * slid)),
             ("asymmetry", None, np.where(s.direction < 0, 1.0, 0.0)), ("sensor-offset", "b", s.direction),
             ("load-dependence", "p", -base * np.log(s.load)),
             ("temperature-dependence", "k_T", base * s.temperature)]
    for order, name in ((1, "runout"), (2, "disc-pattern"), (3, "disc-pattern")):
        terms += [(name, None, np.cos(order * s.angle)), (name, None, np.sin(order * s.angle))]
    terms += [("step", None, (share > at).astype(float)) for at in (0.25, 0.5, 0.75)]
    return [term for term in terms if np.std(term[2]) > 0]


def thresholded(columns, kept_always, mu, threshold):
    """Least squares without the terms that move friction by less than the threshold, again and again."""
    kept = np.ones(columns.shape[1], bool)
    for _ in range(ROUNDS):
        coefficients = np.zeros(columns.shape[1])
        coefficients[kept] = np.linalg.lstsq(columns[:, kept], mu, rcond=None)[0]
        moves = np.abs(coefficients) * columns.std(axis=0)
        now = (moves > threshold) & kept
        now[:kept_always] = True
        if np.array_equal(now, kept):
            break
        kept = now
    return coefficients, kept


def answer(record, s):
    law, effects = law_terms(s), effect_terms(s)
    columns = np.column_stack(law + [term for _, _, term in effects])
    held_out = np.arange(len(s)) * 100 // len(s) % 5 == 4
    left = []
    for threshold in THRESHOLDS:
        coefficients, _ = thresholded(columns[~held_out], len(law), s.mu[~held_out], threshold)
        left.append(np.sqrt(np.mean((columns[held_out] @ coefficients - s.mu[held_out]) ** 2)))
    chosen = max(t for t, error in zip(THRESHOLDS, left) if error <= MOST_WORSE * min(left))
    coefficients, kept = thresholded(columns, len(law), s.mu, chosen)
    named = {}
    for (name, parameter, _), coefficient, is_kept in zip(effects, coefficients[len(law):], kept[len(law):]):
        if not is_kept:
            continue
        named.setdefault(name, {})
        if parameter:
            named[name][parameter] = {"value": float(coefficient)}
    return {"record": record, "effects": [{"effect": name, "parameters": given} for name, given in named.items()],
            "error_left": float(np.sqrt(np.mean((columns @ coefficients - s.mu) ** 2)))}


write((answer(record, s) for record, s in records(sys.argv[1])), sys.argv[2])

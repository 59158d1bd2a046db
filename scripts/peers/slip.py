"""What both Python peers do before they fit: read the trace and keep the slip samples."""

import numpy as np
import pandas as pd

OMEGA_R = 4 * 2 * np.pi / 60 * 15  # disc at the friction radius [mm/s]: 4 rpm, 15 mm


def slip_samples(path):
    """|v_r| [mm/s] and mu against the motion, over the samples in which the block slips."""
    trace = pd.read_csv(path)
    relative_velocity = OMEGA_R - trace["v_b_mm_s"].to_numpy()
    speed = np.abs(relative_velocity)
    noise = 1.4826 * np.median(speed[speed < 0.1 * speed.max()])
    slips = speed > 8 * noise
    friction = trace["mu"].to_numpy() * np.sign(relative_velocity)
    return speed[slips], friction[slips]


def starts(speed, friction):
    """mu_s, mu_k and the decay factor [s/mm] to start a fit from."""
    return friction.max(), friction.min(), 3 / speed.max()


def exponential(v, mu_s, mu_k, alpha):
    return mu_k + (mu_s - mu_k) * np.exp(-alpha * v)


def fractional(v, mu_s, mu_k, beta):
    return mu_k + (mu_s - mu_k) / (1 + beta * v)

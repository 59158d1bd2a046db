"""What the baselines of the benchmark of hidden effects do before they look for an effect: read a record, keep the samples
in which the block slides, thin them."""

import json
import os

import numpy as np
from scipy.signal import savgol_filter

MOST_SAMPLES = 6000


class Sliding:
    """Samples of sliding of all files of a record: v [mm/s], mu against the motion, and what else may matter."""

    def __init__(self, parts):
        for name in parts[0]:
            setattr(self, name, np.concatenate([part[name] for part in parts]))

    def __len__(self):
        return len(self.v)


def channels(folder, file, spring):
    with open(os.path.join(folder, file["file"]), encoding="utf-8") as source:
        header = source.readline().strip().split(",")
        table = np.loadtxt(source, delimiter=",", ndmin=2)
    have = dict(zip(header, table.T))
    n = len(table)
    time = have.get("time_s", np.arange(n, dtype=float))
    step = (time[-1] - time[0]) / (n - 1)
    radius = file["radius_mm"] or 0
    omega = have["speed_rpm"] * 2 * np.pi / 60 if "speed_rpm" in have else np.full(n, (file["speed_rpm"] or 0) * 2 * np.pi / 60)
    if "pull_N" in have:
        window = 41
        v = spring["drive_mm_s"] - savgol_filter(have["pull_N"], window, 2, 1, step) / spring["stiffness_N_per_mm"]
        inertia = spring["mass_kg"] * savgol_filter(v, window, 2, 1, step) * 1e-3
        mu = (savgol_filter(have["pull_N"], window, 2) - inertia) / (file["load_N"] or 1)
    elif "v_r_mm_s" in have:
        v, mu = have["v_r_mm_s"], have["mu"]
    else:
        v, mu = omega * radius - have.get("v_b_mm_s", 0.0), have["mu"]
    smooth = n > 30 and "time_s" in have
    acceleration = savgol_filter(v, 21, 2, 1, step) if smooth else np.zeros(n)
    direction = np.where(v < 0, -1.0, 1.0)
    load = have.get("load_N", np.full(n, file["load_N"] or 1.0))
    return {"time": time, "v": np.abs(v), "mu": mu * direction, "direction": direction,
            "rate": acceleration * direction, "acceleration": acceleration, "angle": np.cumsum(omega) * step,
            "distance": np.cumsum(np.abs(v)) * step, "load": load / load.mean(), "newton": load,
            "temperature": have["temperature_C"] - have["temperature_C"].mean() if "temperature_C" in have else np.zeros(n)}


def sliding(channel, kind):
    v = channel["v"]
    if kind in ("points", "sliding"):
        keep = v > 0
    else:
        slow = v[v < 0.1 * v.max()]
        keep = v > 8 * 1.4826 * np.median(slow)
    return {name: values[keep] for name, values in channel.items()}


def records(folder):
    """(name, Sliding) of each record of the folder."""
    with open(os.path.join(folder, "index.jsonl"), encoding="utf-8") as index:
        for line in index:
            entry = json.loads(line)
            parts = [sliding(channels(folder, file, entry.get("spring")), entry["kind"]) for file in entry["files"]]
            every = max(1, sum(len(part["v"]) for part in parts) // MOST_SAMPLES)
            yield entry["record"], Sliding([{name: values[::every] for name, values in part.items()} for part in parts])


def write(answers, path):
    with open(path, "w", encoding="utf-8") as file:
        for answer in answers:
            file.write(json.dumps(answer) + "\n")

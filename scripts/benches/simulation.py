"""Simulations of stick-slip, events only: one hour of the 15 mm test of [D] by each law, one hour of [U] Fig 2 by the
smoothed law. Status 1 when an hour of [D] by a bare law takes longer than 2 s."""
import subprocess

import harness

RUNS, NEEDS_IDENTIFY, SOURCES, OPTIONS = 1, False, ["src/oscillator"], {}
LIMIT = 2  # [s]


def run(given):
    subprocess.run([harness.REPO / "scripts/setup", "build", "test"], check=True)
    subprocess.run([harness.REPO / "scripts/build", "release", "--target", "simulation_bench"], check=True)
    lines = harness.measured([harness.REPO / "build/release/tests/oscillator/simulation_bench"]).text.splitlines()
    print("\n".join(lines))
    return int(any(float(line.split()[-2]) > LIMIT for line in lines if "of [D]" in line and "+" not in line))

"""`identify plan` on simulated records of 20 s at 20 kHz that leave a question open, with the usual means and with
everything a lab may have: wall and processor time, what is open, and the run that is proposed."""
import json
import os
import statistics
import tempfile

import harness

RUNS, NEEDS_IDENTIFY, SOURCES, OPTIONS = 1, True, ["src/study", "src/diagnosis"], {}
CONDITIONS = [*harness.CONDITIONS, "--load", "50N"]
RECORDS = {  # effect, noise of friction, of v_b
    "lag, loud": ("frictional-lag:tau=0.5ms", "0.01", "0.06mm/s"),
    "filter, loud": ("force-bandwidth:f_0=200Hz,zeta=0.7", "0.012", "0.08mm/s"),
    "heating": ("heating:h=0.05,tau_h=8s", "0.006", "0.04mm/s"),
    "run-in": ("run-in:w=0.05,L=60mm", "0.006", "0.04mm/s"),
    "drift": ("drift:d=-0.004/s", "0.006", "0.04mm/s"),
    "delay, loud": ("channel-delay:delay=0.6ms", "0.012", "0.08mm/s"),
}
MEANS = {
    "usual means": "",
    "speeds, radii, loads": "--speeds 1rpm..8rpm --radii 9mm,12mm,15mm,18mm --loads 20N..100N",
    "everything": "--speeds 1rpm..8rpm --radii 9mm,12mm,18mm --loads 25N,100N --springs 50N/mm --pauses 6s --reversing --tap --lift",
}


def proposal(use):
    """What is open, and the run that would settle it."""
    plan = json.loads(use.text).get("plan", {}) if use.text.strip() else {}
    names = "|".join(model["effect"] or "none" for model in plan.get("models", [])) or "nothing"
    best = next(iter(plan.get("experiments", [])), None)
    return f"{names}; " + (f"{best['text']}, {100 * best['probability']:.0f} %" if best else f"none, status {use.status}")


def run(given):
    harness.print_machine(given)
    table = harness.Table(record="-14", means="-22", wall_s="7.1f", cpu_s="7.1f", open_and_proposed="-120")
    walls = []
    with tempfile.TemporaryDirectory() as folder:
        trace = os.path.join(folder, "trace.csv")
        for name, (effect, friction, velocity) in RECORDS.items():
            noise = ["--noise-mu", friction, "--noise-v", velocity, "--scatter", "0.008"]
            harness.record(given.identify, trace, options=[*CONDITIONS, "--effect", effect, *noise])
            for means, options in MEANS.items():
                command = [given.identify, "plan", "--quiet", "--json", "-", *CONDITIONS, *options.split(), trace]
                use = harness.median([harness.used(command) for _ in range(given.runs)])
                table.row(name, means, use.wall, use.processor, proposal(use))
                walls.append(use.wall)
    print(f"median {statistics.median(walls):.1f}; slowest {max(walls):.1f}")

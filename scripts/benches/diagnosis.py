"""`identify diagnose` on simulated records (nothing, each of some effects, motion that never sticks, a rig that is a hundred
times slower) of 20 s and 120 s at 20 kHz, and on files that are given: median of wall and processor time, memory, and what
was found."""
import json
import os
import shlex
import statistics
import tempfile

import harness

RUNS, NEEDS_IDENTIFY, SOURCES = 3, True, ["src/diagnosis", "src/fit"]
OPTIONS = {"files": {"nargs": "*", "metavar": "'[OPTIONS] FILE'"}}
RIG = ["--radius", "15mm", "--noise-mu", "0.003", "--scatter", "0.003"]
RECORDS = {
    "nothing": "",
    "viscous": "--effect viscous:sigma=0.0015s/mm",
    "frictional-lag": "--effect frictional-lag:tau=2ms",
    "rate-state": "--effect rate-state:D_c=40um,a=0.005",
    "bristle": "--effect bristle:sigma0=60/mm,sigma1=0.001s/mm",
    "contact-spin": "--effect contact-spin:R_c=4mm",
    "run-in": "--effect run-in:w=0.2,L=200mm",
    "runout": "--effect runout:A=0.04,phase=1rad",
    "lag and runout": "--effect frictional-lag:tau=2ms --effect runout:A=0.04,phase=1rad",
}
OTHERS = {  # options, duration, rate
    "never sticks": ("--speed 40rpm --damping-ratio 0.5 --reversing 0.5Hz --noise-v 0.2mm/s", "20s", "20kHz"),
    "a hundred times slower": ("--speed 0.04rpm --mass 8500kg --alpha 5s/mm --damping-ratio 0.02 --noise-v 2um/s", "2000s", "200Hz"),
}


def run(given):
    harness.print_machine(given)
    table = harness.Table(record="-38", wall_s="7.2f", cpu_s="7.2f", MB="5.0f", found="-70")

    def row(name, words):
        command = [given.identify, "diagnose", "--quiet", "--json", "-", *words]
        use = harness.median([harness.used(command) for _ in range(given.runs)])
        diagnosis = json.loads(use.text).get("diagnosis", {}) if use.status == 0 else {}
        found = [rung["added"] for rung in diagnosis.get("ladder", []) if rung["added"]]
        table.row(name, use.wall, use.processor, use.memory, f"{diagnosis.get('verdict', 'failed')}: {', '.join(found) or '-'}")
        return use.wall

    with tempfile.TemporaryDirectory() as folder:
        trace = os.path.join(folder, "trace.csv")
        for duration in ("20s", "120s"):
            walls = []
            for name, options in RECORDS.items():
                options = [*RIG, "--speed", "4rpm", "--noise-v", "0.2mm/s", *options.split()]
                harness.record(given.identify, trace, duration, options=options)
                walls.append(row(f"{name}, {duration}", [*harness.CONDITIONS, trace]))
            print(f"median, {duration}: {statistics.median(walls):.2f}; slowest {max(walls):.2f}\n")
        for name, (options, duration, rate) in OTHERS.items():
            harness.record(given.identify, trace, duration, rate, [*RIG, *options.split()])
            row(f"{name}, {duration}", ["--radius", "15mm", trace])
    for file in given.files:
        row(file[-38:], shlex.split(file))

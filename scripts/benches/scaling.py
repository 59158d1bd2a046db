"""How the cost of `identify` grows: processor time and memory over rows (a fit of 12 s to 12 minutes at 20 kHz), cycles
(a diagnosis of 10 s to 160 s), candidates (a diagnosis with formulas of one's own beside the catalogue) and runs (a batch
of 1 to 64 copies of 5 s). The exponent is the slope of log(time) over log(size), from the second size on, since the first
holds what is done once; the rest of it is cost that does not grow."""
import math
import os
import shutil
import statistics
import tempfile

import harness

RUNS, NEEDS_IDENTIFY, SOURCES, OPTIONS = 3, True, ["src/diagnosis", "src/fit", "src/campaign"], {}


def run(given):
    harness.print_machine(given)
    with tempfile.TemporaryDirectory() as folder:
        trace, runs = os.path.join(folder, "trace.csv"), os.path.join(folder, "runs")
        fit = [given.identify, "--radius", "15mm", "--quiet"]
        diagnosis = [given.identify, "diagnose", "--radius", "15mm", "--quiet"]

        def series(name, sizes, prepare, command_of, anew=False):
            """prepare: called for each size, or anew for each run."""
            table = harness.Table(**{name: "12d", "cpu_s": "8.3f", "MB": "6.0f"})
            times = []
            for size in sizes:
                rounds = []
                for k in range(given.runs):
                    if k == 0 or anew:
                        prepare(size)
                    rounds.append(harness.measured(command_of(size), cwd=folder))
                use = harness.median(rounds)
                table.row(size, use.processor, use.memory)
                times.append(use.processor)
            slope, _ = statistics.linear_regression([math.log(max(size, 1)) for size in sizes[1:]],
                                                    [math.log(time) for time in times[1:]])
            print(f"exponent {slope:.2f}\n", flush=True)

        series("rows", [240000, 720000, 2400000, 7200000, 14400000],
               lambda rows: harness.record(given.identify, trace, f"{rows // 20000}s"), lambda rows: [*fit, trace])
        series("cycles", [52, 104, 208, 416, 832],
               lambda cycles: harness.record(given.identify, trace, f"{10 * cycles // 52}s", "10kHz"),
               lambda cycles: [*diagnosis, trace])
        harness.record(given.identify, trace, rate="10kHz")
        formulas = [f"own{k} = a*v^{0.2 + 0.1 * k}/(w+v); a=0.001, w={4 + k}mm/s" for k in range(32)]
        series("formulas", [0, 4, 8, 16, 32], lambda count: None,
               lambda count: [*diagnosis, *(word for text in formulas[:count] for word in ("--formula", text)), trace])
        harness.record(given.identify, trace, "5s", "10kHz")

        def batch(count):
            shutil.rmtree(runs, ignore_errors=True)
            shutil.rmtree(runs + "-results", ignore_errors=True)
            harness.copies(trace, runs, [f"r{k}.csv" for k in range(count)], 10)

        series("runs", [1, 4, 16, 64], batch, lambda count: [*fit, "--threads", "2", runs], anew=True)

"""identify beside pandas + SciPy, lmfit, R data.table + minpack.lm doing the same two fits on the same trace of two
minutes at 20 kHz, then identify alone on a tenth, on five and on ten times the rows, and reading alone (identify columns):
medians of wall time and of peak memory. Status 1 when a limit is missed. Runs take turns, since the speed of a machine that
others use as well changes in minutes; before each one memory is touched and given back: a virtual machine gives pages that
are free for some seconds back to its host, and their first touch takes twenty times as long (measured: 440 to 860 MB/s
against 10 to 12 GB/s), which would be counted for whichever contender happens to meet it."""
import mmap
import os
import statistics
import subprocess

import harness

RUNS, NEEDS_IDENTIFY, SOURCES = 10, False, ["src/ingest", "src/kinematics", "src/fit"]
OPTIONS = {"--trace": {"help": "in place of the simulated one"}}
TOUCHED = 800 << 20  # bytes, more than the largest of them needs
PYTHON = "/usr/bin/python3"  # Debian's, which has Debian's pandas, SciPy and lmfit


def touch_memory():
    if os.fork() == 0:  # in a process apart, whose end gives it back
        with mmap.mmap(-1, TOUCHED, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS) as memory:
            for page in range(0, TOUCHED, mmap.PAGESIZE):
                memory[page] = 1
        os._exit(0)
    os.wait()


def contenders(given, work):
    """Commands by name, and how many bytes the tenfold trace is longer."""
    peers, trace = harness.REPO / "scripts/peers", given.trace or work / "trace.csv"
    files = {"a tenth": ("12s", work / "tenth.csv"), "fivefold": ("600s", work / "fivefold.csv"),
             "tenfold": ("1200s", work / "tenfold.csv"), "": ("120s", work / "trace.csv")}
    for duration, file in files.values():
        if not file.exists():
            harness.record(given.identify, file, duration, options=harness.CONDITIONS)
    fit, columns = [given.identify, *harness.CONDITIONS], [given.identify, "columns"]
    return {"identify": [*fit, trace],
            "pandas + SciPy": [PYTHON, "-B", peers / "fit_scipy.py", trace],
            "pandas + lmfit": [PYTHON, "-B", peers / "fit_lmfit.py", trace],
            "data.table + minpack.lm": ["Rscript", peers / "fit_r.R", trace],
            "data.table reads only": ["Rscript", peers / "read_r.R", trace],
            **{f"identify, {name}": [*fit, file] for name, (_, file) in files.items() if name},
            "identify columns": [*columns, trace],
            "identify columns, tenfold": [*columns, files["tenfold"][1]],
            }, os.path.getsize(files["tenfold"][1]) - os.path.getsize(trace)


def run(given):
    subprocess.run([harness.REPO / "scripts/setup", "build", "peers"], check=True)
    subprocess.run([harness.REPO / "scripts/build", "release", "--target", "identify"], check=True)
    work = harness.REPO / "build/bench"
    work.mkdir(exist_ok=True)
    commands, more_bytes = contenders(given, work)
    uses = {name: [] for name in commands}
    for _ in range(given.runs):
        for name, command in commands.items():
            touch_memory()
            uses[name].append(harness.measured(command))
    middle = {name: harness.median(runs) for name, runs in uses.items()}
    ours = middle["identify"]
    harness.print_machine(given)
    table = harness.Table(contender="-26", median_s="9.3f", least="7.3f", most="7.3f", MB="6.0f", identify_takes="15.2f")
    for name, use in middle.items():
        walls = [one.wall for one in uses[name]]
        table.row(name, use.wall, min(walls), max(walls), use.memory,
                  None if name.startswith("identify") else ours.wall / use.wall)
    pairs = zip(uses["identify columns, tenfold"], uses["identify columns"])
    reading = more_bytes / 1e6 / statistics.median(tenfold.processor - once.processor for tenfold, once in pairs)
    limits = [  # what, measured, limit, whether it is the most
        ("time over that of pandas + SciPy", ours.wall / middle["pandas + SciPy"].wall, 0.25, True),
        ("time over that of data.table reading only", ours.wall / middle["data.table reads only"].wall, 0.6, True),
        ("peak memory on two minutes [MB]", ours.memory, 90, True),
        ("peak memory on ten minutes [MB]", middle["identify, fivefold"].memory, 500, True),
        ("time of ten times the rows over ten times the time", middle["identify, tenfold"].wall / (10 * ours.wall), 1.15, True),
        ("reading of all columns [MB/s a core]", reading, 600, False),
    ]
    print()
    missed = 0
    for what, value, limit, is_most in limits:
        misses = value > limit if is_most else value < limit
        missed += misses
        print(f"{'MISSED' if misses else 'ok    '}  {what}: {value:.3g}, at {'most' if is_most else 'least'} {limit:g}")
    return int(missed > 0)

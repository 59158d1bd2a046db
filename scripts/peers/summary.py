"""Table of medians, ratios and peak memory, and the limits.

usage: summary.py MEMORY.tsv TIMES.json... [--about TEXT] [--more-bytes N] [--markdown FILE]

TIMES.json: of hyperfine, one for each round of all contenders in turn. --more-bytes: by which the tenfold file is
longer than the trace; from it and the processor time that `identify columns` takes more follows the speed of reading.
--markdown: where the table is written. Status 1 when a limit is missed.
"""

import argparse
import json
import statistics
import sys

parser = argparse.ArgumentParser(usage=__doc__)
parser.add_argument("memory")
parser.add_argument("times", nargs="+")
parser.add_argument("--about", default="")
parser.add_argument("--more-bytes", type=int, default=0)
parser.add_argument("--markdown")
given = parser.parse_args()

runs = {}
for path in given.times:
    with open(path, encoding="utf-8") as file:
        for result in json.load(file)["results"]:
            runs.setdefault(result["command"], []).append(result)


def times(name):
    return [run["median"] for run in runs[name]]


def median(name):
    return statistics.median(times(name))


with open(given.memory, encoding="utf-8") as file:
    peaks = {}
    for line in file:
        name, kib = line.rstrip("\n").split("\t")
        peaks.setdefault(name, []).append(int(kib) * 1024 / 1e6)
memory = {name: statistics.median(values) for name, values in peaks.items()}

ours = median("identify") if "identify" in runs else None
print(f"{'':26}{'median':>9}{'min':>9}{'max':>9}{'peak memory':>14}" + (f"{'identify takes':>18}" if ours else ""))
for name in runs:
    ratio = f"{ours / median(name):>15.2f} of it" if ours and not name.startswith("identify") else ""
    print(f"{name:26}{median(name):>7.3f} s{min(times(name)):>7.3f} s{max(times(name)):>7.3f} s"
          f"{memory[name]:>11.0f} MB{ratio}")
if not ours:
    sys.exit(0)


def processor_times(name):
    return [run["user"] + run["system"] for run in runs[name]]


linearity = median("identify, tenfold") / (10 * ours)
pairs = zip(processor_times("identify columns, tenfold"), processor_times("identify columns"), strict=True)
reading = given.more_bytes / 1e6 / statistics.median(tenfold - once for tenfold, once in pairs)
limits = [  # what, measured, limit, whether it is the most or the least
    ("time over that of pandas + SciPy", ours / median("pandas + SciPy"), 0.25, "most"),
    ("time over that of data.table reading only", ours / median("data.table reads only"), 0.6, "most"),
    ("peak memory on two minutes [MB]", memory["identify"], 90, "most"),
    ("peak memory on ten minutes [MB]", memory["identify, fivefold"], 500, "most"),
    ("time of ten times the rows over ten times the time", linearity, 1.15, "most"),
    ("reading of all columns [MB/s a core]", reading, 600, "least"),
]


def holds(measured, limit, end):
    return measured <= limit if end == "most" else measured >= limit


print()
for what, measured, limit, end in limits:
    print(f"{'ok    ' if holds(measured, limit, end) else 'MISSED'}  {what}: {measured:.3g}, at {end} {limit:g}")

if given.markdown:
    rows = [f"{given.about}; medians.", "", "| | time | peak memory | `identify` takes |", "|---|---|---|---|"]
    for name in runs:
        ratio = "" if name.startswith("identify") else f"{ours / median(name):.2f} of it"
        rows.append(f"| {name} | {median(name):.3f} s | {memory[name]:.0f} MB | {ratio} |")
    rows += ["", "| | measured | limit |", "|---|---|---|"]
    for what, measured, limit, end in limits:
        verdict = "" if holds(measured, limit, end) else ", missed"
        rows.append(f"| {what} | {measured:.3g} | at {end} {limit:g}{verdict} |")
    with open(given.markdown, "w", encoding="utf-8") as file:
        file.write("\n".join(rows) + "\n")
sys.exit(0 if all(holds(measured, limit, end) for _, measured, limit, end in limits) else 1)

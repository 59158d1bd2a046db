"""Table of medians, ratios and peak memory, and the limits.

usage: summary.py TIMES.json MEMORY.tsv [--about TEXT] [--more-bytes N] [--markdown FILE]

--more-bytes: by which the tenfold file is longer than the trace; from it and the processor time that `identify columns`
takes more follows the speed of reading. --markdown: where the table is written. Status 1 when a limit is missed.
"""

import argparse
import json
import statistics
import sys

parser = argparse.ArgumentParser(usage=__doc__)
parser.add_argument("times")
parser.add_argument("memory")
parser.add_argument("--about", default="")
parser.add_argument("--more-bytes", type=int, default=0)
parser.add_argument("--markdown")
given = parser.parse_args()

with open(given.times, encoding="utf-8") as file:
    results = {result["command"]: result for result in json.load(file)["results"]}
with open(given.memory, encoding="utf-8") as file:
    peaks = {}
    for line in file:
        name, kib = line.rstrip("\n").split("\t")
        peaks.setdefault(name, []).append(int(kib) * 1024 / 1e6)
memory = {name: statistics.median(values) for name, values in peaks.items()}

ours = results.get("identify", {}).get("median")
print(f"{'':26}{'median':>9}{'min':>9}{'max':>9}{'peak memory':>14}" + (f"{'identify takes':>18}" if ours else ""))
for name, result in results.items():
    ratio = f"{ours / result['median']:>15.2f} of it" if ours and not name.startswith("identify") else ""
    print(f"{name:26}{result['median']:>7.3f} s{result['min']:>7.3f} s{result['max']:>7.3f} s"
          f"{memory[name]:>11.0f} MB{ratio}")
if not ours:
    sys.exit(0)


def processor_time(name):
    return results[name]["user"] + results[name]["system"]


linearity = results["identify, tenfold"]["median"] / (10 * ours)
more_time = processor_time("identify columns, tenfold") - processor_time("identify columns")
reading = given.more_bytes / 1e6 / more_time
limits = [  # what, measured, limit, whether it is the most or the least
    ("time over that of pandas + SciPy", ours / results["pandas + SciPy"]["median"], 0.25, "most"),
    ("time over that of data.table reading only", ours / results["data.table reads only"]["median"], 0.6, "most"),
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
    for name, result in results.items():
        ratio = "" if name.startswith("identify") else f"{ours / result['median']:.2f} of it"
        rows.append(f"| {name} | {result['median']:.3f} s | {memory[name]:.0f} MB | {ratio} |")
    rows += ["", "| | measured | limit |", "|---|---|---|"]
    for what, measured, limit, end in limits:
        verdict = "" if holds(measured, limit, end) else ", missed"
        rows.append(f"| {what} | {measured:.3g} | at {end} {limit:g}{verdict} |")
    with open(given.markdown, "w", encoding="utf-8") as file:
        file.write("\n".join(rows) + "\n")
sys.exit(0 if all(holds(measured, limit, end) for _, measured, limit, end in limits) else 1)

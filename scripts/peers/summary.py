"""Table of medians, ratios and peak memory, and the limits. usage: summary.py TIMES.json MEMORY.tsv

Status 1 when a limit is missed.
"""

import json
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    results = {result["command"]: result for result in json.load(file)["results"]}
with open(sys.argv[2], encoding="utf-8") as file:
    memory = {name: int(kib) * 1024 / 1e6 for name, kib in (line.rstrip("\n").split("\t") for line in file)}

ours = results.get("identify", {}).get("median")
print(f"{'':26}{'median':>9}{'min':>9}{'max':>9}{'peak memory':>14}" + (f"{'identify takes':>18}" if ours else ""))
for name, result in results.items():
    ratio = f"{ours / result['median']:>15.2f} of it" if ours and not name.startswith("identify") else ""
    print(f"{name:26}{result['median']:>7.3f} s{result['min']:>7.3f} s{result['max']:>7.3f} s"
          f"{memory[name]:>11.0f} MB{ratio}")
if not ours:
    sys.exit(0)

linearity = results["identify, tenfold"]["median"] / (10 * ours)
limits = [  # what, measured, at most
    ("time over that of pandas + SciPy", ours / results["pandas + SciPy"]["median"], 0.4),
    ("time over that of data.table reading only", ours / results["data.table reads only"]["median"], 1.0),
    ("peak memory on two minutes [MB]", memory["identify"], 250),
    ("time of ten times the rows over ten times the time", linearity, 1.15),
]
print()
for what, measured, limit in limits:
    print(f"{'ok    ' if measured <= limit else 'MISSED'}  {what}: {measured:.3g}, at most {limit:g}")
sys.exit(0 if all(measured <= limit for _, measured, limit in limits) else 1)

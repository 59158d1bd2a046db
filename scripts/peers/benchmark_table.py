"""data/validation/benchmark.md from the answers in a folder. usage: benchmark_table.py FOLDER SCORE"""

import json
import subprocess
import sys

folder, score = sys.argv[1:]
SOLVERS = [("`identify diagnose`", "identify"), ("AIC over single effects", "aic"), ("sparse regression", "sparse")]


def scored(answers):
    told = subprocess.run([sys.executable, "-B", score, "--json", f"{folder}/truth/truth.jsonl", f"{folder}/{answers}.jsonl"],
                          check=True, capture_output=True, text=True)
    return json.loads(told.stdout)


def percent(part):
    return "-" if part is None else f"{100 * part:.0f} %"


def number(x, digits=2):
    return "-" if x is None else f"{x:.{digits}f}"


results = [scored(answers) for _, answers in SOLVERS]
first = results[0]


def of(counts):
    return sum(counts.values())


ROWS = [
    (f"one effect hidden ({of(first['single'])} records): named, alone or in a group of at most four",
     lambda r: percent(r["named_part"]["single"])),
    ("of these alone", lambda r: str(r["single"]["alone"])),
    ("something else named, or nothing", lambda r: f"{r['single']['wrong'] + r['single']['beside']}, {r['single']['missed']}"),
    (f"several hidden ({of(first['several'])} records): all named", lambda r: percent(r["named_part"]["several"])),
    ("of these some named", lambda r: str(r["several"]["partly"])),
    ("mean size of the group that holds a hidden effect", lambda r: number(r["group_size"])),
    ("effects named that are not there, where some are", lambda r: str(r["effects_named_that_are_not_there"])),
    (f"nothing hidden ({first['nothing_hidden']['records']} records): something named",
     lambda r: f"{r['nothing_hidden']['named']} (at most {percent(r['nothing_hidden']['at_most_95'])})"),
    ("called unexplained there", lambda r: str(r["nothing_hidden"]["unexplained"])),
    (f"in no list ({first['in_no_list']['records']} records): called unexplained, something named",
     lambda r: f"{r['in_no_list']['unexplained']}, {r['in_no_list']['named']}"),
    ("parameters given", lambda r: str(r["parameters"]["given"])),
    ("of these within 10 %", lambda r: percent(r["parameters"]["within_10_percent"])),
    ("95 % intervals that hold the truth",
     lambda r: f"{percent(r['parameters']['covered'])} of {r['parameters']['intervals']}"),
    ("error left over that of the true law, median", lambda r: number(r["error_left"]["median_over_true_law"], 3)),
    ("within 1.15 of it", lambda r: percent(r["error_left"]["within_1.15"])),
]

print(f"""`scripts/export-benchmark FOLDER` writes {first['records']} records in which effects of the catalogue are hidden, alone and in pairs, with
the truth kept apart, a page that states the task and a script that scores answers (Python alone): stick-slip on rigs of
every size, sliding, tables of points, spring sliders; white, AR(1) and 1/f noise; records with nothing hidden, and some with what
no list holds. `scripts/benchmark-baselines` made this table:

| what is asked | {' | '.join(name for name, _ in SOLVERS)} |
|---|{'--:|' * len(SOLVERS)}""")
for name, value in ROWS:
    print(f"| {name} | {' | '.join(value(result) for result in results)} |")
print("""
AIC over single effects: fifteen effects, each alone beside an exponential and a fractional law, by `scipy.optimize.curve_fit`; the
least AIC is named where it is ten below that of the bare law, every sample being one observation. Sparse regression: sequentially
thresholded least squares (Brunton, Proctor and Kutz 2016) on exponentials of speed and twenty terms that stand for effects; the
threshold is chosen on blocks that are held out. Both know the samples in which the block slides by a threshold on v_r and
nothing of break-away, of memory or of the instruments. The records are of our own simulation, and the effects those of our own
catalogue: that `identify` does better on them proves little; that a plain method names something where nothing is hidden does not
depend on it.""")

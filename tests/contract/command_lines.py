#!/usr/bin/env python3
"""Types random command lines, which a grammar of all verbs, options, kinds of record and outputs makes.

The verbs and their options are those that the help lists. Whatever is typed, the command ends by itself within 20 s,
with a status that it documents; where it fails it says why, and what it wrote is whole.

usage: command_lines.py IDENTIFY [--count N] [--seed N]   of 2,000 lines; exit status 1 and the lines that offend
       command_lines.py --self-test                       proves that each rule can fail
"""

import argparse
import json
import math
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile

LONGEST = 20  # s
STATUSES = (0, 1, 2, 3)
RAW = re.compile(r"std::|terminate called|Assertion|basic_string|vector::|bad_[a-z]+|\bstoi\b|\bstod\b")

# Of each option two values that are meant, then others; {} is a name that nothing has yet.
VALUES = dict(line.partition(" ")[::2] for line in re.sub(r"\n +", " ", """
--radius 15mm 15mm 0.9cm 6mm,9mm 15 -3mm 1e300mm
--speed 4rpm 4rpm 0.4rad/s 6mm/s 0s:2um/s,20s:10um/s 4 0rpm
--load 50N 50N 5kgf 50 -1N
--instruments lab.json missing.json
--kind KIND KIND KIND nothing
--columns time=time_s mu=mu spring=pull:N x_b=nothing mu
--units mu=1 v_b=mm/s v_b=furlong
--rate 1kHz 5kHz 20 1e-9Hz
--with RECORD missing.csv
--with-columns v_b=v_b_mm_s mu=mu
--with-units v_b=mm/s
--continue RECORD
--stick-below 0.5mm/s 5mm/s 1
--trim
--never-sticks
--stiffness 1N/mm 16N/mm 1e-9N/mm 5
--mass 10g 3kg 0kg 1
--damping 0.5Ns/m 0.01Ns/mm 1e9Ns/m 1
--damping-ratio 0.02 0.2 5 1e3 -1
--rubs-on ground base wall
--evolution ageing slip old
--states 1 2 3
--detrend displacement time auto none all
--reference-speed 1um/s 1
--from 1s 30s 1e6s 3
--to 90s 100s -1s 3
--law exponential fractional coulomb logarithmic gaussian quadratic
--formula q=a*v;a=0.001 hump=a*exp(-v/w);a=0.02,w=6mm/s x=1/0 x=v/0;a=1 @missing.txt
--effect viscous frictional-lag runout rate-state bristle load-coupling viscous:sigma=0.001s/mm
    runout:A=0.05,phase=1rad runout:A=x vicous
--loss squares huber soft-l1 cubic
--starts 1 3 0
--folds 2 5 900 1
--seed 1 77 -1
--protocol both joint published none
--profile
--start mu_s=0.45 alpha=0.05s/mm D_c=5um alpha=0.05 zz=1
--bounds mu_s=0.3..0.7 mu_k=0.3..0.3 k=0.004..0.004/um mu_s=0.7..0.3 alpha=1..2
--cycles 2..9 0..0 9..2 50..60
--exclude 1s..2s 0s..1e9s 2..1
--threads 1 2 -1
--json {}.json - - missing/x.json
--csv {} RECORD
--report {}.html
--figures {}
--format svg pdf png eps
--out {}.csv {} RECORD
--pattern {radius}mm_{repeat}.csv r{x
--shard 1/2 2/2 3/2
--compare earlier.csv missing.csv
--share alpha mu_s nothing
--vary mu_s:radius mass stiffness alpha nothing
--time-limit 1s 3s 5
--confirm RECORD missing.csv
--speeds 1rpm..8rpm 2rpm,8rpm 1..8rpm 3
--radii 9mm,18mm 9
--loads 20N..100N
--springs 5N/mm,20N/mm
--rates 5kHz 50
--minutes 0.1 0.2 0
--pauses 10s 3
--mass-below 10g 1
--range 1mm/s..20mm/s 1rpm..8rpm 9mm/s..1mm/s 1..3
--at 2mm/s,6mm/s 4rpm 0rpm 6
--points 3 5 1
--harmonics 3 20 0
--factor 1.5 2 1
--x stiffness=8N/mm..20N/mm:3 ratio=0.01..1e4:3 mass:3 nothing
--y mass=0.5kg..1.5kg:3 load alpha=1..2:3
--measure stick-time energy nothing
--sharpness 500s/mm 5
--duration 2s 5s 100s 1e300s 5
--run-up 1s 3
--reversing 0.5Hz 0Hz -1Hz 2
--noise-colour 0.5 1
--speed-steps 0s:2rpm,1s:4rpm 0s:2um/s,20s:10um/s,60s:2um/s 0s:0,5s:2um/s 0:1 x
--pause 1s,1s 1s
--load-swing 10N,1s 90N,1s 10N
--temperature 20degC..60degC 20degC..60degC,3s 20..60
--rate-state a=0.01,b=0.015,D_c=8um,k=0.004/um a=0.01,b=0.9 a D_c=8
--drift 1e-5/s 1
--scatter 0.004 -1
--wander 0.5 1 7
--noise-mu 0.003 1e9
--noise-v 0.02mm/s 1
--delay 1ms -1ms 1
--force-bandwidth 200Hz -5Hz
--force-damping 0.7 0
--velocity-gain 1.02 0
--high-pass 1Hz 1
--mu-s 0.5 0.1 -1
--mu-k 0.3 9
--alpha 0.05s/mm 0.05
--beta 0.05s/mm 1
--v-s 9mm/s 9
--mu-0 0.4 -1
--session missing.json
--port 0 99999999
""").strip().split("\n"))
KINDS = "stick-slip sliding points spring-slider motion-only force-only velocity-steps slide-hold-slide".split()
# What a record of a kind needs to be read.
RECORDS = {
    "stick.csv": "--radius 15mm --speed 4rpm --load 50N", "sliding.csv": "", "points.csv": "--kind points",
    "force.csv": "",
    "frame.csv": "--mass 3kg --stiffness 1200N/m", "steps.csv": "", "holds.csv": "", "runs": "--radius 15mm",
    "pull.csv": "--kind spring-slider --columns spring=pull:N --speed 1mm/s --stiffness 1N/mm --mass 10g",
    "empty.csv": "", "words.csv": "", "missing.csv": "", "results": "",
}
GOOD = list(RECORDS)[:9]
# What a verb or an option needs beside it, to be more than a usage error or longer than is waited for.
NEEDED = {
    "diagnose": "--time-limit", "plan": "--time-limit --minutes", "study map": "--x --y",
    "simulate": "--out --duration", "--format": "--figures", "--with-columns": "--with", "--with-units": "--with",
    "--share": "--out", "--vary": "--out",
}
LEFT_OUT = {"study speed": ("--formula",)}  # 200 draws of the critical speed take 17 s on two cores
OWN_WORDS = {  # what a verb is given besides options
    "": "RECORD", "diagnose": "RECORD", "plan": "RECORD", "rig": "RECORD", "twin": "RECORD", "explore": "RECORD",
    "columns": "RECORD", "manifest": "runs results stick.csv", "merge": "results runs missing",
    "cite": "runout found.json nothing",
    "effects": "viscous bristle vicous", "help": "files kinds nothing", "completion": "bash zsh fish tcsh",
    "simulate": "",
}


def table(path, header, rows):
    text = "\n".join(",".join(f"{cell:.9g}" for cell in row) for row in rows)
    path.write_text(header + "\n" + text + "\n", encoding="utf-8")


def make_records(run, folder):
    noise = "--noise-mu 0.003 --noise-v 0.02mm/s --scatter 0.004 --quiet"
    run(f"simulate --radius 15mm --duration 4s --rate 2kHz {noise} --out stick.csv")
    (folder / "runs").mkdir()
    for name in ("15mm_1", "15mm_2", "9mm_1"):
        run(f"simulate --radius {name.split('_')[0]} --duration 3s --rate 1kHz {noise} --out runs/{name}.csv")
    run("runs --radius 15mm --out results --quiet")
    run("--radius 15mm --json found.json --quiet stick.csv")
    steps = "--rate 20Hz --rate-state a=0.01,b=0.015,D_c=8um,k=0.004/um --noise-mu 0.0002 --quiet --speed-steps"
    for name, kind, speeds in (("steps", "velocity-steps", "0s:2um/s,20s:10um/s,50s:2um/s,90s:10um/s"),
                               ("holds", "slide-hold-slide", "0s:5um/s,30s:0,40s:5um/s,70s:0,100s:5um/s")):
        run(f"simulate --kind {kind} --duration 140s {steps} {speeds} --out {name}.csv")
    speeds = [0.08 + 0.079 * math.sin(0.0063 * i) for i in range(4000)]
    friction = [0.25 + 0.15 * math.exp(-50 * v) + 0.8 * v + 0.003 * math.sin(77.7 * i) for i, v in enumerate(speeds)]
    both = [(mu, 1e3 * v) for mu, v in zip(friction, speeds)]
    table(folder / "sliding.csv", "time_s,mu,v_r [mm/s]", [(0.005 * i, *row) for i, row in enumerate(both)])
    table(folder / "points.csv", "mu,v_r [mm/s]", both[:1000:20])
    saw = [8 + 0.01 * (k % 410) if k % 410 < 400 else 12 - 0.4 * (k % 410 - 400) for k in range(9000)]
    saw = [force + 0.01 * math.sin(77.7 * i) for i, force in enumerate(saw)]
    table(folder / "force.csv", "time_s,force [N]", [(0.001 * i, force) for i, force in enumerate(saw)])
    table(folder / "pull.csv", "time_s,pull [N]", [(0.001 * i, 0.1 * force) for i, force in enumerate(saw)])
    rows = []
    for i in range(6000):
        t, a = 0.002 * i, 2e-3 * math.exp(-1e-4 * i)
        s, c = math.sin(7 * t), math.cos(7 * t)
        pull = 3 * a * (-48.9975 * s - 0.7 * c) + math.copysign(0.8, 7 * c - 0.05 * s)
        rows.append((t, 1e3 * (a * s + 3e-7 * math.sin(1000.3 * i)), 1e3 * (a * s + pull / 1200)))
    table(folder / "frame.csv", "time_s,x_b [mm],x_d [mm]", rows)
    (folder / "empty.csv").write_text("", encoding="utf-8")
    (folder / "words.csv").write_text("time_s,mu,v_b\none,two,three\n" * 9, encoding="utf-8")
    (folder / "earlier.csv").write_text("radius_mm,mu_s\n15,0.5\n9,0.5\n", encoding="utf-8")
    (folder / "lab.json").write_text('{"vibrometer": {"gain": [1.0, 0.01]}}', encoding="utf-8")


def options_of(help_text):
    """Names of options in the help of a verb, with whether each takes a value."""
    found = re.findall(r"^  (?:-\w,)?(--[a-z][a-z0-9-]*)([, ].*)?$", help_text, re.MULTILINE)
    return {name: bool(re.match(r" [A-Z]", rest or "")) for name, rest in found if name not in ("--help", "--version")}


class Grammar:
    def __init__(self, options, seed):
        self.options = options  # of each verb
        self.random = random.Random(seed)
        self.outputs = 0

    def value_of(self, option):
        values = VALUES.get(option, "1 0.5 5mm x").split(" ")
        value = self.random.choice(values[:2] if self.random.random() < 0.85 else values)
        self.outputs += 1
        for word, names in (("KIND", KINDS), ("RECORD", list(RECORDS))):
            value = self.random.choice(names) if value == word else value
        return value.replace("{}", f"out/{self.outputs}")

    def line(self):
        verb = self.random.choice(list(self.options))
        options = self.options[verb]
        words, behind = [], []

        def add(option, value=None):
            if option not in options or option in words or option in LEFT_OUT.get(verb, ()): return
            words.extend([option, value or self.value_of(option)] if options[option] else [option])
            need(option)

        def need(name):
            for option in NEEDED.get(name, "").split(): add(option)

        own = OWN_WORDS.get(verb, "RECORD NONE").split(" ")
        several = verb in ("", "diagnose", "plan") and self.random.random() < 0.3
        for _ in range(2 if several else self.random.random() < 0.97):
            name = self.random.choice(own)
            if name == "RECORD": name = self.random.choice(GOOD if self.random.random() < 0.85 else list(RECORDS))
            if name in ("", "NONE"): continue
            behind.append(name)
            if self.random.random() < 0.9:
                for option, value in re.findall(r"(--\S+) (\S+)", RECORDS.get(name, "")): add(option, value)
        for option in self.random.sample(sorted(options), min(len(options), self.random.choice((0, 1, 1, 1, 2, 2, 4)))):
            add(option)
        need(verb)
        return verb.split() + words + behind


def offence_in(status, seconds, out, err, written, quiet=False):
    """What is wrong with how a command ended; empty: nothing. status: negative where a signal ended it."""
    if seconds > LONGEST: return f"did not end within {LONGEST} s"
    if status not in STATUSES: return f"ended with status {status}"
    if status != 0 and len(err.strip()) < 10: return f"failed with status {status} and does not say why"
    if status == 0 and not out.strip() and not written and not quiet: return "says and writes nothing"
    if RAW.search(err + out): return "shows what is meant for programmers: " + RAW.search(err + out).group()
    for name, text in written.items():
        if not name.endswith(".json"): continue
        try:
            json.loads(text)
        except ValueError as error:
            return f"wrote {name}, which is no JSON: {error}"
    return ""


def run_line(identify, words, folder):
    """(status, seconds, out, err); a server is interrupted once it has had its time."""
    serves = words[:1] == ["explore"]
    with subprocess.Popen([identify, *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          errors="replace", stdin=subprocess.DEVNULL) as process:
        begin = os.times().elapsed
        for wait, ending in ((2 if serves else LONGEST, signal.SIGINT), (5, signal.SIGKILL), (5, signal.SIGKILL)):
            try:
                out, err = process.communicate(timeout=wait)
                break
            except subprocess.TimeoutExpired:
                process.send_signal(ending)
        ended = process.returncode
        if serves and ended == -signal.SIGINT: ended = 0  # as the signal would have it
        return ended, os.times().elapsed - begin, out, err


def main(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("identify")
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args(arguments)
    identify = os.path.abspath(given.identify)
    with tempfile.TemporaryDirectory() as directory:
        folder, work = pathlib.Path(directory) / "records", pathlib.Path(directory) / "work"
        folder.mkdir()

        def run(words):
            done = subprocess.run([identify, *words.split()], cwd=folder, capture_output=True, text=True, check=False)
            if done.returncode > 1: raise RuntimeError(f"identify {words}: {done.returncode}\n{done.stderr}")
            return done.stdout

        make_records(run, folder)
        verbs = [""] + re.findall(r"^  ([a-z]+)  +[A-Z]", run("--help").split("Subcommands:")[-1], re.MULTILINE)
        studies = re.findall(r"^  ([a-z]+)  +[A-Z]", run("study --help").split("Subcommands:")[-1], re.MULTILINE)
        verbs = [verb for verb in verbs if verb != "study"] + [f"study {kind}" for kind in studies]
        grammar = Grammar({verb: options_of(run(f"{verb} --help")) for verb in verbs}, given.seed)
        print(f"{len(verbs)} verbs with {sum(map(len, grammar.options.values()))} options")
        offences, ends, slowest = [], dict.fromkeys(STATUSES, 0), (0, "")
        for _ in range(given.count):
            words = grammar.line()
            shutil.copytree(folder, work)  # a line may write onto the records
            (work / "out").mkdir()
            status, seconds, shown, said = run_line(identify, words, work)
            files = [path for path in (work / "out").rglob("*") if path.is_file()]
            written = {path.name: path.read_text(encoding="utf-8", errors="replace") for path in files}
            shutil.rmtree(work)
            ends[status] = ends.get(status, 0) + 1
            line = "identify " + " ".join(f"'{word}'" if re.search(r"[^\w./:,=@+-]", word) else word for word in words)
            slowest = max(slowest, (seconds, line))
            wrong = offence_in(status, seconds, shown, said, written, "--quiet" in words)
            if wrong:
                offences.append(f"{line}\n  {wrong}; {said.strip()[:300]}")
                print(offences[-1], flush=True)
        print(f"{given.count} lines, statuses {ends}, slowest {slowest[0]:.1f} s: {slowest[1]}")
        return 1 if offences else 0


def self_test():
    fine = (0, 1, "result", "", {})
    assert not offence_in(*fine)
    assert not offence_in(2, 1, "", "identify: error: no trace given", {})
    for bad in ((-9, 25, "", "", {}), (0, 21, "x", "", {}), (-11, 1, "", "", {}), (134, 1, "", "terminate", {}),
                (1, 1, "", "", {}), (0, 1, "", "", {}), (1, 1, "", "identify: error: basic_string::substr", {}),
                (0, 1, "x", "", {"a.json": "{"})):
        assert offence_in(*bad), bad
    shown = "  -h,--help    Print\n  --radius TEXT  Friction\n  --quiet     Do"
    assert options_of(shown) == {"--radius": True, "--quiet": False}
    same = [Grammar({"": {"--radius": True, "--law": True}}, 7).line() for _ in range(2)]
    assert same[0] == same[1]


if __name__ == "__main__":
    if sys.argv[1:] == ["--self-test"]:
        self_test()
    else:
        sys.exit(main(sys.argv[1:]))

#!/usr/bin/env python3
"""Checks that data/schema/tribofit.schema.json says what the command writes.

Records of every kind, a diagnosis, one of several traces and a batch are made and analysed; each JSON file must follow
the schema, which knows every name in it. What the schema names, one of them has: nothing in it is out of date.

usage: json_schema.py REPOSITORY IDENTIFY     exit status 1 and one line per offence
       json_schema.py --self-test REPOSITORY  proves that each rule can fail
"""

import copy
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    print("skipped: needs python3-jsonschema (scripts/setup test)")
    sys.exit(77)

SCHEMA = "data/schema/tribofit.schema.json"
NOISE = "--noise-mu 0.003 --noise-v 0.05mm/s --scatter 0.004 --rate 2kHz --quiet"


def errors_of(document, kind, schema):
    """What in a document of this kind does not follow the schema."""
    part = {"$ref": "#/$defs/" + kind, "$defs": schema["$defs"]}
    for error in jsonschema.Draft202012Validator(part).iter_errors(document):
        yield "/".join(str(step) for step in error.absolute_path) + ": " + error.message[:200]


def names_in(document):
    if isinstance(document, dict):
        for name, value in document.items():
            yield name
            yield from names_in(value)
    if isinstance(document, list):
        for value in document:
            yield from names_in(value)


def names_of(schema):
    """Every name that the schema describes."""
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
        for value in schema.values():
            yield from names_of(value)
    if isinstance(schema, list):
        for value in schema:
            yield from names_of(value)


def offences(documents, schema):
    """documents: (name, kind, JSON) of what was written."""
    jsonschema.Draft202012Validator.check_schema(schema)
    found, met = [], set()
    for name, kind, document in documents:
        found += [f"{name}: {error}" for error in errors_of(document, kind, schema)]
        met.update(names_in(document))
    return found + [f"{SCHEMA}: nothing has '{name}'" for name in sorted(set(names_of(schema)) - met)]


def table(path, header, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([header, *rows])


def make_other_kinds(folder):
    """Records without friction or without motion; the physics is that of tests/cli/kinds_test.cpp."""
    mass, stiffness, friction, turn, fade = 3, 1200, 0.8, 7, 0.05
    rows = []
    for i in range(8000):
        t = i * 0.002
        a, s, c = 2e-3 * math.exp(-fade * t), math.sin(turn * t), math.cos(turn * t)
        pull = mass * a * ((fade**2 - turn**2) * s - 2 * fade * turn * c) + math.copysign(friction, turn * c - fade * s)
        rows.append((t, 1e3 * (a * s + 3e-7 * math.sin(1000.3 * i)), 1e3 * (a * s + pull / stiffness)))
    table(folder / "frame.csv", ["time_s", "x_b [mm]", "x_d [mm]"], rows)
    falls = [(8 + 0.01 * k if k < 400 else 12 - 0.4 * (k - 400)) for k in range(410)]
    cell = [(i * 0.001, falls[i % 410] + 0.01 * math.sin(77.7 * i)) for i in range(12000)]
    table(folder / "cell.csv", ["time_s", "force [N]"], cell)
    table(folder / "pull.csv", ["time_s", "pull [N]"], [(t, 0.1 * force) for t, force in cell])
    speeds = [(1 if i % 2 else -1) * 0.5 * 1.1**i for i in range(60)]
    table(folder / "points.csv", ["v_r [mm/s]", "mu"],
          [(v, math.copysign(0.3 + 0.2 * math.exp(-0.05 * abs(v)) + 0.002 * math.sin(37 * v), v)) for v in speeds])


def make_steps(folder):
    rows = list(csv.reader((folder / "bare.csv").read_text(encoding="utf-8").splitlines()))
    table(folder / "steps.csv", rows[0] + ["step"], [row + [1 if 2 * k < len(rows) else 2] for k, row in
                                                     enumerate(rows[1:])])


def written(identify, repository):
    """What the command writes: (name, kind, JSON)."""
    out = []
    with tempfile.TemporaryDirectory() as directory:
        folder = pathlib.Path(directory)

        def run(words, statuses=(0,)):
            done = subprocess.run([identify, *words.split()], cwd=folder, capture_output=True, text=True, check=False)
            if done.returncode not in statuses:
                raise RuntimeError(f"identify {words}: {done.returncode}\n{done.stderr}")

        def result(name, words):
            run(f"{words} --quiet --json {name}.json", (0, 1))  # 1: read, but there is no law
            out.append((words, "result", json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))))

        (folder / "runs").mkdir()
        run(f"simulate --radius 15mm --duration 6s --seed 1 {NOISE} --out bare.csv")
        for seed, name in enumerate(("hidden", "again", "held"), 2):
            run(f"simulate --radius 15mm --duration 12s --seed {seed} --effect runout:A=0.06 {NOISE} --out {name}.csv")
        make_other_kinds(folder)
        make_steps(folder)
        result("bare", "--radius 15mm --load 50N --profile bare.csv")
        result("steps", "--radius 15mm,15mm steps.csv")
        result("points", "--kind points points.csv")
        result("cell", "cell.csv")
        result("frame", "--mass 3kg --stiffness 1200N/m --law coulomb frame.csv")
        result("pull", "--kind spring-slider --columns spring=pull:N --speed 1mm/s --stiffness 1N/mm --mass 10g pull.csv")
        run("simulate --kind velocity-steps --rate 10Hz --duration 120s --speed-steps 0s:2um/s,20s:10um/s,50s:0,70s:10um/s "
            "--noise-mu 0.0002 --out driven.csv")
        result("driven", "driven.csv")
        result("hidden", "diagnose --radius 15mm --load 50N hidden.csv --confirm held.csv")
        run(f"simulate --radius 15mm --duration 6s --seed 1 --effect frictional-lag:tau=0.5ms --noise-mu 0.006 "
            "--noise-v 0.02mm/s --scatter 0.008 --rate 4kHz --quiet --out open.csv")
        result("plan", "plan --radius 15mm --load 50N --tap --lift --rates 50kHz --pauses 1s --minutes 0.1 open.csv")
        result("both", "diagnose --radius 15mm --load 50N hidden.csv again.csv")
        for radius in (9, 12, 15):
            for repeat in (1, 2):
                run(f"simulate --radius {radius}mm --duration 6s --seed {radius}{repeat} {NOISE} "
                    f"--out runs/r{radius}mm_{repeat}.csv")
        (folder / "runs/r18mm_1.csv").write_text("bad,file\n1,2\n", encoding="utf-8")
        run("manifest runs --out runs/manifest.csv")
        rows = list(csv.reader((folder / "runs/manifest.csv").read_text(encoding="utf-8").splitlines()))
        table(folder / "runs/manifest.csv", rows[0] + ["lot"], [row + [f"L{k % 2}"] for k, row in enumerate(rows[1:])])
        run(f"runs --out results --quiet --speed 4rpm --load 50N --share alpha --compare {repository}/data/published/table4.csv",
            (0, 1))
        for path in sorted((folder / "results").glob("*.json")):
            kind = {"campaign": None, "summary": "summary", "pooled": "pooled"}.get(path.stem, "result")
            if kind:
                out.append((path.name, kind, json.loads(path.read_text(encoding="utf-8"))))
        for path in sorted((folder / "results/kept").glob("*.json")):
            out.append((path.name, path.suffixes[-2][1:], json.loads(path.read_text(encoding="utf-8"))))
    return out


def self_test(schema):
    """A name that is missing in the schema, one that is too many, and a value of another type are found."""
    shorter, longer = copy.deepcopy(schema), copy.deepcopy(schema)
    del shorter["$defs"]["estimate"]["properties"]["ci95"]
    longer["$defs"]["estimate"]["properties"]["ci99"] = {}
    estimate = {"value": 1.5, "std_error": None, "ci95": [1, 2]}
    trials = [(schema, estimate, False), (shorter, estimate, True), (schema, {**estimate, "value": "1.5"}, True)]
    right = [bool(list(errors_of(document, "estimate", part))) == wrong for part, document, wrong in trials]
    right.append(any("ci99" in offence for offence in offences([], longer)))
    print(f"json schema: {sum(right)} of {len(right)} made-up schemas judged rightly")
    return 0 if all(right) else 1


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    repository = pathlib.Path(arguments[1 if arguments[0] == "--self-test" else 0]).resolve()
    schema = json.loads((repository / SCHEMA).read_text(encoding="utf-8"))
    if arguments[0] == "--self-test":
        return self_test(schema)
    documents = written(arguments[1], repository)
    found = offences(documents, schema)
    print("\n".join(found) if found else f"json schema: {len(documents)} files follow it")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

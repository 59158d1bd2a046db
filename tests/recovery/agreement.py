#!/usr/bin/env python3
"""Two questions with one answer, and two halves of one record, for any records.

usage: agreement.py IDENTIFY [RECORDS]   RECORDS: a file with the options and files of one record a line (default:
                                              standard input), as for `identify diagnose`; paths from where it is run

For each record, `diagnose` names effects, and `identify` fits the best law with them: every parameter must have the
same digits, to a thousandth of its standard error, where both searches end. (Effects of the motion are undone, not
fitted: such records are not compared.) Then each half of the record is diagnosed by itself (`--exclude`): the names of
the first half must be among those of the second or of its groups, and parameters that both have must agree within
three standard errors of their difference, or the verdict says that the law does not hold. The exit status is 1 where
any record disagrees.
"""

import json
import math
import os
import shlex
import subprocess
import sys
import tempfile


def result(command, verb, words):
    """The JSON of one run; None where it made none."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "result.json")
        subprocess.run([command, *verb, *words, "--quiet", "--json", path], capture_output=True, check=False)
        if not os.path.exists(path):
            return None
        with open(path, encoding="utf-8") as file:
            return json.load(file)


def names(diagnosis):
    return [rung["added"] for rung in diagnosis["ladder"] if rung["added"]]


def groups(diagnosis):
    return [{rung["added"], *rung["equivalent"]} for rung in diagnosis["ladder"] if rung["added"]]


def share_names(first, second):
    """As many effects, and for each of the first a group of the second that shares a name with its group."""
    a, b = groups(first), groups(second)
    return len(a) == len(b) and all(any(x & y for y in b) for x in a)


def best(found):
    return found["fits"][found["best"]]


def parameters(fit):
    return {(p["effect"] or "", p["name"]): p for p in fit["parameters"]}


def alike(p, q):
    """Of one parameter: equal but for where a search ends."""
    errors = [x["std_error"] for x in (p, q)]
    if not all(isinstance(e, (int, float)) for e in errors):
        return not any(isinstance(e, (int, float)) for e in errors)  # the data say nothing of it
    return abs(p["value"] - q["value"]) <= 1e-3 * errors[0] and abs(errors[1] - errors[0]) <= 1e-3 * errors[0]


def same_digits(command, words, found):
    """Whether `identify` with the effects found gives the numbers of `diagnose`."""
    fit = best(found)
    if set(names(found["diagnosis"])) - set(fit["effects"]):
        return "effect of the motion"
    options = ["--law", fit["law"]] + [word for name in fit["effect_names"] for word in ("--effect", name)]
    again = result(command, [], [*options, *words])
    if again is None:
        return "identify failed"
    for other in again["fits"]:
        if other["protocol"] == fit["protocol"] and other["effects"] == fit["effects"]:
            of_other = parameters(other)
            same = all(alike(p, of_other[key]) for key, p in parameters(fit).items())
            return "same digits" if same else "OTHER DIGITS"
    return "no such fit"


def half(command, words, found, first):
    duration = found["trace"]["duration_s"]
    left_out = f"{duration / 2}s..{2 * duration}s" if first else f"0s..{duration / 2}s"
    return result(command, ["diagnose"], [*words, "--exclude", left_out])


def compared(first, second):
    """What two halves say of each other, and whether they agree."""
    a, b = best(first), best(second)
    verdicts = {first["diagnosis"]["verdict"], second["diagnosis"]["verdict"]}
    if not share_names(first["diagnosis"], second["diagnosis"]) or a["law"] != b["law"]:
        text = f"{a['law']}+{names(first['diagnosis'])} against {b['law']}+{names(second['diagnosis'])}"
        return text, bool(verdicts & {"unexplained", "not-enough-data"})
    largest, which = 0, "nothing"
    of_second = parameters(b)
    for key, p in parameters(a).items():
        q = of_second.get(key, {})
        if not all(isinstance(x.get("std_error"), (int, float)) and x["std_error"] > 0 for x in (p, q)):
            continue
        if p["unit"] == "rad" or key[1] in ("phase", "t_c"):
            continue  # of the record, not of the contact
        z = abs(p["value"] - q["value"]) / math.hypot(p["std_error"], q["std_error"])
        if z > largest:
            largest, which = z, ".".join(key).strip(".")
    agrees = largest <= 3 or a.get("conditional") or b.get("conditional")
    return f"largest difference {largest:.1f} standard errors ({which})", agrees


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    lines = open(sys.argv[2], encoding="utf-8") if len(sys.argv) == 3 else sys.stdin
    bad = 0
    for line in lines:
        words = shlex.split(line, comments=True)
        if not words:
            continue
        found = result(sys.argv[1], ["diagnose"], words)
        if found is None or "diagnosis" not in found or not found.get("fits"):
            print(f"{words[-1]}: no diagnosis")
            continue
        digits = same_digits(sys.argv[1], words, found)
        halves = [half(sys.argv[1], words, found, first) for first in (True, False)] if "trace" in found else [None]
        if all(h and h.get("fits") for h in halves):
            text, agrees = compared(*halves)
        else:
            text, agrees = "halves not diagnosed", True
        agrees = agrees and digits in ("same digits", "effect of the motion")
        bad += not agrees
        print(f"{'ok  ' if agrees else 'MISS'} {os.path.basename(words[-1])}: "
              f"{', '.join(names(found['diagnosis'])) or 'nothing'} ({found['diagnosis']['verdict']}); {digits}; {text}",
              flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())

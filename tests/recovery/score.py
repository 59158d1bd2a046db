#!/usr/bin/env python3
"""Scores answers to the benchmark of hidden effects. Needs Python 3.9 alone; README.md beside the records says what is
asked and how answers are written.
usage: score.py [--json] [--each] TRUTH.jsonl ANSWERS.jsonl   (--each: a line for each record)
"""
import argparse
import json
import math
import sys

LARGEST_GROUP = 4
NAMINGS = ("alone", "group", "beside", "partly", "wrong", "missed")


def read_lines(path):
    """The objects of a file of JSON lines by their "record"."""
    out = {}
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if not line.strip():
                continue
            try:
                item = json.loads(line)
                name = item["record"]
            except (ValueError, TypeError, KeyError) as error:
                sys.exit(f"{path}, line {number}: no JSON object with a \"record\": {error}")
            if name in out:
                sys.exit(f"{path}, line {number}: {name} stands there twice")
            out[name] = item
    return out


def names_of(effect):
    return [effect["effect"], *effect.get("or", [])]


def naming_of(hidden, named):
    """How well the hidden effects were named, and the sizes of the groups that hold one. Each name is used once; a group
    that is too large counts as a name of something else."""
    used, sizes, alone, hits = set(), [], True, 0
    for key in hidden:
        for k, effect in enumerate(named):
            group = names_of(effect)
            if k in used or key not in group:
                continue
            sizes.append(len(group))
            if len(group) > LARGEST_GROUP:
                continue
            used.add(k)
            alone = alone and len(group) == 1
            hits += 1
            break
    if not named:
        return "missed", sizes
    if hits == 0:
        return "wrong", sizes
    if hits < len(hidden):
        return "partly", sizes
    if hits < len(named):
        return "beside", sizes
    return ("alone" if alone else "group"), sizes


def upper_bound_95(hits, count):
    """Upper end of the one-sided 95 % interval of a rate (Clopper-Pearson)."""
    if hits >= count:
        return 1.0
    low, high = hits / count, 1.0
    for _ in range(60):
        rate = (low + high) / 2
        at_most = sum(math.comb(count, k) * rate**k * (1 - rate) ** (count - k) for k in range(hits + 1))
        low, high = (rate, high) if at_most > 0.05 else (low, rate)
    return high


def difference(parameter, value):
    """Of a phase, within a turn."""
    off = value - parameter["value"]
    return math.remainder(off, 2 * math.pi) if parameter["unit"] == "rad" else off


def parameters_of(hidden, named):
    """(within 10 %, inside the interval or None) of each main parameter that the answer gives."""
    for what in hidden:
        for effect in named:
            if effect["effect"] != what["effect"]:
                continue
            given = effect.get("parameters", {})
            for parameter in what["parameters"]:
                if not parameter.get("main") or parameter["name"] not in given:
                    continue
                answer = given[parameter["name"]]
                off = difference(parameter, answer["value"])
                scale = 1 if parameter["unit"] == "rad" else abs(parameter["value"])
                covered = None
                if answer.get("ci95"):
                    low, high = answer["ci95"]
                    half, middle = (high - low) / 2, (high + low) / 2
                    covered = abs(difference(parameter, middle)) <= half * (1 + 1e-12)
                yield abs(off) <= 0.1 * scale, covered


def score(truth, answers):
    unknown = sorted(set(answers) - set(truth))
    if unknown:
        sys.exit(f"answers to records that the truth does not know: {', '.join(unknown[:5])}")
    out = {"records": len(truth), "answered": len(answers), "each": {}}
    namings = {1: dict.fromkeys(NAMINGS, 0), 2: dict.fromkeys(NAMINGS, 0)}
    sizes, near, inside, left = [], [], [], []
    silent = {"records": 0, "named": 0, "unexplained": 0}
    alien = {"records": 0, "unexplained": 0, "named": 0}
    others = 0
    for record, true in truth.items():
        answer = answers.get(record, {})
        named = answer.get("effects", [])
        says_unexplained = bool(answer.get("unexplained", False))
        hidden = true["hidden"]
        if true["expected"] == "silent":
            silent["records"] += 1
            silent["named"] += bool(named)
            silent["unexplained"] += says_unexplained and not named
            verdict = "named" if named else "unexplained" if says_unexplained else "silent"
        elif true["expected"] == "unexplained":
            alien["records"] += 1
            alien["named"] += bool(named)
            alien["unexplained"] += says_unexplained and not named
            verdict = "named" if named else "unexplained" if says_unexplained else "silent"
        else:
            verdict, of_groups = naming_of([what["effect"] for what in hidden], named)
            namings[min(2, len(hidden))][verdict] += 1
            sizes += of_groups
            keys = {what["effect"] for what in hidden}
            others += sum(not keys & set(names_of(effect)) for effect in named)
            for is_near, covered in parameters_of(hidden, named):
                near.append(is_near)
                if covered is not None:
                    inside.append(covered)
        if true.get("floor_rmse") and answer.get("error_left"):
            left.append(answer["error_left"] / true["floor_rmse"])
        out["each"][record] = verdict
    left.sort()
    out.update({
        "single": namings[1], "several": namings[2],
        "named_part": {
            "single": rate(namings[1]["alone"] + namings[1]["group"], sum(namings[1].values())),
            "several": rate(namings[2]["alone"] + namings[2]["group"], sum(namings[2].values()))},
        "group_size": sum(sizes) / len(sizes) if sizes else None,
        "effects_named_that_are_not_there": others,
        "nothing_hidden": {**silent, "false_alarm_rate": rate(silent["named"], silent["records"]),
                           "at_most_95": upper_bound_95(silent["named"], silent["records"]) if silent["records"] else None},
        "in_no_list": alien,
        "parameters": {"given": len(near), "within_10_percent": rate(sum(near), len(near)),
                       "intervals": len(inside), "covered": rate(sum(inside), len(inside))},
        "error_left": {"records": len(left), "median_over_true_law": left[len(left) // 2] if left else None,
                       "within_1.15": rate(sum(x <= 1.15 for x in left), len(left))}})
    return out


def rate(hits, count):
    return hits / count if count else None


def percent(part):
    return "-" if part is None else f"{100 * part:.1f} %"


def show(result):
    single, several = result["single"], result["several"]
    lines = [f"{result['records']} records, {result['answered']} answers"]
    for what, counts, part in (("one effect hidden", single, result["named_part"]["single"]),
                               ("several hidden", several, result["named_part"]["several"])):
        if sum(counts.values()):
            lines.append(f"{what}: {sum(counts.values())} records, named {percent(part)} ("
                         + ", ".join(f"{counts[naming]} {naming}" for naming in NAMINGS) + ")")
    if result["group_size"]:
        lines.append(f"mean size of the group that holds a hidden effect: {result['group_size']:.2f}")
    lines.append(f"effects named that are not there, where some are: {result['effects_named_that_are_not_there']}")
    silent, alien = result["nothing_hidden"], result["in_no_list"]
    if silent["records"]:
        lines.append(f"nothing hidden: {silent['records']} records, false alarms {silent['named']} "
                     f"({percent(silent['false_alarm_rate'])}, at most {percent(silent['at_most_95'])}), "
                     f"\"unexplained\" {silent['unexplained']}")
    if alien["records"]:
        lines.append(f"in no list: {alien['records']} records, \"unexplained\" {alien['unexplained']}, named {alien['named']}")
    parameters, left = result["parameters"], result["error_left"]
    lines.append(f"parameters: {parameters['given']} given, within 10 % {percent(parameters['within_10_percent'])}; "
                 f"{parameters['intervals']} intervals, {percent(parameters['covered'])} hold the truth")
    if left["records"]:
        lines.append(f"error left over that of the true law: median {left['median_over_true_law']:.3f}, "
                     f"within 1.15: {percent(left['within_1.15'])} of {left['records']}")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("truth")
    parser.add_argument("answers")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--each", action="store_true")
    given = parser.parse_args()
    truth = read_lines(given.truth)
    result = score(truth, read_lines(given.answers))
    each = result.pop("each")
    if given.each:
        for record, verdict in each.items():
            hidden = " + ".join(what["effect"] for what in truth[record]["hidden"]) or truth[record]["expected"]
            print(f"{record} {hidden}: {verdict}")
    print(json.dumps(result, indent=1) if given.json else show(result))


if __name__ == "__main__":
    main()

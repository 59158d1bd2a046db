"""Answers of `identify diagnose` to the benchmark of hidden effects. usage: benchmark_identify.py RECORDS ANSWERS.jsonl IDENTIFY"""

import json
import os
import subprocess
import sys


def command_of(identify, folder, entry):
    words = [identify, "diagnose", "--json", "-", "--quiet", "--threads", "2"]
    first = entry["files"][0]
    if entry["kind"] == "points":
        words += ["--kind", "points"]
    elif entry["kind"] == "sliding":
        words += ["--kind", "sliding"]
    elif entry["kind"] == "spring-slider":
        spring = entry["spring"]
        words += ["--kind", "spring-slider", "--columns", "spring=pull_N:N", "--speed", f"{spring['drive_mm_s']}mm/s",
                  "--stiffness", f"{spring['stiffness_N_per_mm']}N/mm", "--mass", f"{spring['mass_kg']}kg", "--load",
                  f"{first['load_N']}N"]
    if entry["kind"] in ("stick-slip", "sliding") and len(entry["files"]) == 1:
        words += ["--radius", f"{first['radius_mm']}mm", "--load", f"{first['load_N']}N"]
        if first["speed_rpm"]:
            words += ["--speed", f"{first['speed_rpm']:.9g}rpm"]
    return words + [os.path.join(folder, file["file"]) for file in entry["files"]]


def parameters_of(finding):
    out = {}
    for p in finding.get("parameters", []):
        if p.get("effect", finding["key"]) not in (None, finding["key"]):
            continue
        out[p["name"]] = {"value": p["value"]}
        if p.get("ci95") and None not in p["ci95"]:
            out[p["name"]]["ci95"] = p["ci95"]
    return out


def answer_of(record, told):
    diagnosis = told["diagnosis"]
    found = {finding["key"]: finding for finding in diagnosis["effects"]}
    effects = []
    for rung in diagnosis["ladder"]:
        if rung["added"]:
            effects.append({"effect": rung["added"], "or": rung["equivalent"],
                            "parameters": parameters_of(found.get(rung["added"], {"key": rung["added"]}))})
    # What is found in the motion before any fit stands in no rung.
    grouped = {key for effect in effects for key in [effect["effect"], *effect["or"]]}
    for key, finding in found.items():
        if finding["status"] == "missing" and key not in grouped:
            beside = [other for other, f in found.items() if f["status"] == "equivalent" and other not in grouped]
            effects.append({"effect": key, "or": beside, "parameters": parameters_of(finding)})
            grouped.update([key, *beside])
    out = {"record": record, "effects": effects}
    if diagnosis["verdict"] == "unexplained":
        out["unexplained"] = True
    if diagnosis["ladder"] and diagnosis["ladder"][-1].get("rmse"):
        out["error_left"] = diagnosis["ladder"][-1]["rmse"]
    return out


def main():
    folder, path, identify = sys.argv[1:]
    with open(os.path.join(folder, "index.jsonl"), encoding="utf-8") as index:
        entries = [json.loads(line) for line in index]
    with open(path, "w", encoding="utf-8") as answers:
        for entry in entries:
            run = subprocess.run(command_of(identify, folder, entry), capture_output=True, text=True, check=False)
            answer = {"record": entry["record"], "effects": []}
            if run.returncode in (0, 1) and run.stdout:
                answer = answer_of(entry["record"], json.loads(run.stdout))
            else:
                print(f"{entry['record']}: status {run.returncode}: {run.stderr[:300]}", file=sys.stderr)
            answers.write(json.dumps(answer) + "\n")
            answers.flush()


main()

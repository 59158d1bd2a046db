#!/usr/bin/env python3
"""Checks that score.py scores known answers right. usage: score_test.py SCORE"""
import importlib.machinery
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import unittest

SCORE = sys.argv.pop()


def loaded():
    loader = importlib.machinery.SourceFileLoader("score_benchmark", SCORE)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("score_benchmark", loader))
    loader.exec_module(module)
    return module


def hidden(effect, value=2.0, unit="ms", main=True):
    return {"effect": effect, "parameters": [{"name": "p", "value": value, "unit": unit, "main": main}]}


def true(record, *effects, expected="named", floor=0.003):
    return {"record": record, "expected": expected, "hidden": list(effects), "floor_rmse": floor}


def named(effect, *others, **parameters):
    return {"effect": effect, "or": list(others), "parameters": parameters}


TRUTH = [true("alone", hidden("lag")), true("group", hidden("lag")), true("large", hidden("lag")),
         true("beside", hidden("lag")), true("wrong", hidden("lag")), true("missed", hidden("lag")),
         true("both", hidden("lag"), hidden("runout", 3.1, "rad")), true("partly", hidden("lag"), hidden("runout")),
         true("once", hidden("lag"), hidden("drift")), true("quiet", expected="silent"), true("loud", expected="silent"),
         true("unsure", expected="silent"), true("alien", expected="unexplained"),
         true("taken", expected="unexplained"), true("no floor", hidden("lag"), floor=None)]
ANSWERS = [
    {"record": "alone", "effects": [named("lag", p={"value": 2.1, "ci95": [1.9, 2.3]})], "error_left": 0.003},
    {"record": "group", "effects": [named("delay", "lag", "bristle", p={"value": 9})], "error_left": 0.0033},
    {"record": "large", "effects": [named("lag", "b", "c", "d", "e", p={"value": 3.0, "ci95": [2.5, 3.5]})]},
    {"record": "beside", "effects": [named("lag"), named("drift")], "error_left": 0.006},
    {"record": "wrong", "effects": [named("runout")]},
    {"record": "both", "effects": [named("runout", p={"value": -3.1, "ci95": [-3.2, -3.0]}), named("lag", "delay")]},
    {"record": "partly", "effects": [named("runout"), named("step")]},
    {"record": "once", "effects": [named("lag", "drift")]},  # one name for two effects
    {"record": "loud", "effects": [named("viscous")]},
    {"record": "unsure", "effects": [], "unexplained": True},
    {"record": "alien", "effects": [], "unexplained": True},
    {"record": "taken", "effects": [named("viscous")], "unexplained": True},
    {"record": "no floor", "effects": [named("lag")], "error_left": 0.001},
]


class ScoreTest(unittest.TestCase):
    def setUp(self):
        module = loaded()
        by_name = lambda items: {item["record"]: item for item in items}
        self.module, self.result = module, module.score(by_name(TRUTH), by_name(ANSWERS))

    def test_naming(self):
        wanted = {"alone": "alone", "group": "group", "large": "wrong", "beside": "beside", "wrong": "wrong",
                  "missed": "missed", "both": "group", "partly": "partly", "once": "partly", "quiet": "silent",
                  "loud": "named", "unsure": "unexplained", "alien": "unexplained", "taken": "named", "no floor": "alone"}
        self.assertEqual(self.result["each"], wanted)
        self.assertEqual(self.result["single"],
                         {"alone": 2, "group": 1, "beside": 1, "partly": 0, "wrong": 2, "missed": 1})
        self.assertEqual(self.result["several"],
                         {"alone": 0, "group": 1, "beside": 0, "partly": 2, "wrong": 0, "missed": 0})
        self.assertAlmostEqual(self.result["named_part"]["single"], 3 / 7)

    def test_groups_and_false_names(self):
        # alone 1, group 3, large 5, beside 1, both 1 + 2, partly 1, once 2, no floor 1
        self.assertAlmostEqual(self.result["group_size"], 17 / 9)
        self.assertEqual(self.result["effects_named_that_are_not_there"], 3)  # drift, runout, step

    def test_silence(self):
        silent = self.result["nothing_hidden"]
        self.assertEqual((silent["records"], silent["named"], silent["unexplained"]), (3, 1, 1))
        alien = self.result["in_no_list"]
        self.assertEqual((alien["records"], alien["unexplained"], alien["named"]), (2, 1, 1))

    def test_parameters(self):
        parameters = self.result["parameters"]  # alone, large, both (a phase across the turn)
        self.assertEqual((parameters["given"], parameters["intervals"]), (3, 3))
        self.assertAlmostEqual(parameters["within_10_percent"], 2 / 3)
        self.assertAlmostEqual(parameters["covered"], 2 / 3)

    def test_error_left(self):
        left = self.result["error_left"]
        self.assertEqual(left["records"], 3)
        self.assertAlmostEqual(left["median_over_true_law"], 1.1)
        self.assertAlmostEqual(left["within_1.15"], 2 / 3)

    def test_bound(self):
        self.assertAlmostEqual(self.module.upper_bound_95(0, 59), 1 - 0.05 ** (1 / 59), 9)
        self.assertAlmostEqual(self.module.upper_bound_95(3, 800), 0.00966, 4)  # qbeta(0.95, 4, 797)
        self.assertEqual(self.module.upper_bound_95(2, 2), 1)

    def test_command(self):
        with tempfile.TemporaryDirectory() as folder:
            paths = [os.path.join(folder, name) for name in ("truth.jsonl", "answers.jsonl")]
            for path, items in zip(paths, (TRUTH, ANSWERS)):
                with open(path, "w", encoding="utf-8") as file:
                    file.writelines(json.dumps(item) + "\n" for item in items)
            run = lambda *words: subprocess.run([sys.executable, "-B", SCORE, *words], capture_output=True, text=True)
            told = run("--json", *paths)
            self.assertEqual(told.returncode, 0, told.stderr)
            self.assertEqual(json.loads(told.stdout)["single"]["alone"], 2)
            self.assertIn("false alarms 1 (33.3 %", run(*paths).stdout)
            with open(paths[1], "a", encoding="utf-8") as file:
                file.write('{"record": "alone"}\n')
            twice = run(*paths)
            self.assertNotEqual(twice.returncode, 0)
            self.assertIn("twice", twice.stderr)


if __name__ == "__main__":
    unittest.main()

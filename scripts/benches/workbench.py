"""`identify explore` as its page would call it, on a simulated record of 20 s at 20 kHz: the answer, to its last byte, to
every effect alone and to random sets of three, 200 changes in ten seconds, and memory over many refits. The page itself is
not drawn. Each time is the median over the servers (--runs), each of which is asked for a set once. How soon it ends:
scripts/bench stop."""
import os
import random
import statistics
import tempfile
import threading
import time

import harness

RUNS, NEEDS_IDENTIFY, SOURCES = 5, True, ["src/workbench", "src/fit"]
OPTIONS = {"--refits": {"type": int, "default": 300}}
WANTED = 100  # [ms]


def answer_times(workbench, order, alone, three):
    """Adds the time of a server's first answer to every effect alone, and to random sets of three in that order."""
    workbench.show()
    for effect in workbench.ask("GET", "/api/begin")["effects"]:
        took, answer = workbench.show([effect["name"]])
        if "rung" in answer:
            alone.setdefault((effect["name"],), []).append(took)
    draw = random.Random(1)
    sets = {tuple(sorted(draw.sample(sorted(key for key, in alone), 3))) for _ in range(128)}
    for effects in random.Random(order).sample(sorted(sets), len(sets)):
        took, answer = workbench.show(effects)
        if "rung" in answer:
            three.setdefault(effects, []).append(took)


def print_answers(what, times):
    middle = {effects: statistics.median(took) for effects, took in times.items()}
    slowest = sorted(middle, key=middle.get, reverse=True)[:5]
    every = [took for own in times.values() for took in own]
    print(f"{what} ({len(middle)} that can be fitted, medians of {len(every) // len(middle)} servers): "
          f"median {statistics.median(middle.values()):.0f} ms, above {WANTED} ms {sum(t > WANTED for t in middle.values())}")
    print("  slowest: " + ", ".join(f"{' + '.join(effects)} {middle[effects]:.0f}" for effects in slowest))
    print(f"  of {len(every)} answers {sum(t > WANTED for t in every)} above {WANTED} ms, the slowest {max(every):.0f}", flush=True)


def run(given):
    harness.print_machine(given)
    with tempfile.TemporaryDirectory() as folder:
        trace = os.path.join(folder, "trace.csv")
        harness.record(given.identify, trace)
        alone, three = {}, {}
        for server in range(given.runs):
            workbench = harness.Workbench(given.identify, trace)
            answer_times(workbench, server, alone, three)
            if server + 1 < given.runs:
                workbench.ended_after()
        print_answers("one effect", alone)
        print_answers("three effects, random sets", three)
        draw, keys = random.Random(2), sorted(key for key, in alone)
        askers, begin = [], time.monotonic()
        for _ in range(200):
            askers.append(threading.Thread(target=workbench.show, args=(draw.sample(keys, 2),)))
            askers[-1].start()
            time.sleep(0.05)
        changed = time.monotonic()
        for asker in askers:
            asker.join()
        print(f"200 changes in {changed - begin:.1f} s: the last answer {1e3 * (time.monotonic() - changed):.0f} ms after the "
              "last change")
        sizes = []
        for k in range(given.refits):
            workbench.show(draw.sample(keys, 2))
            if k % max(1, given.refits // 5) == 0:
                sizes.append(workbench.megabytes())
        print(f"memory over {given.refits} refits [MB]: " + ", ".join(f"{size:.0f}" for size in [*sizes, workbench.megabytes()]))
        workbench.ended_after()

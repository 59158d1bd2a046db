"""Pages in Chromium: the workbench on a simulated record of 20 s at 20 kHz (from a click that adds a third effect to the
answer with the charts in view, and to the charts near the view too; on the page as it opens and on one whose charts were
all looked at; then a jump to a chart farther down), and the summary page of a campaign of 1,000 runs (5 s at 1 kHz each,
which costs the page the same as longer ones; they are fitted first, with processor time and memory beside those of 250 of
them). Needs the browser tests of the release build."""
import os
import random
import shutil
import subprocess
import sys
import tempfile

import harness

RUNS, NEEDS_IDENTIFY, SOURCES = 1, True, ["src/workbench", "src/report"]
OPTIONS = {"--campaign": {"type": int, "default": 1000, "help": "runs of it"},
           "--changes": {"type": int, "default": 40, "help": "in the workbench"}}


def make_campaign(trace, folder, count):
    """Half of the conditions are repeated."""
    harness.copies(trace, folder, [f"r{k:04}.csv" for k in range(count)], 2)
    draw = random.Random(1)
    with open(os.path.join(folder, "manifest.csv"), "w", encoding="utf-8") as manifest:
        manifest.write("file,radius_mm,speed_rpm,load_N,temperature_degC,repeat\n")
        for k in range(count):
            condition = (f"{30 + k // 2 % 40},{15 + draw.randrange(40)}", 1) if k % 2 else (f"50,{20 + k // 20}", k // 2 % 10 + 1)
            manifest.write(f"r{k:04}.csv,15,4,{condition[0]},{condition[1]}\n")


def run(given):
    driver = harness.REPO / "build/release/tests/page/node_modules/playwright-core/index.mjs"
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not driver.exists() or not chromium:
        sys.exit("bench page: build with scripts/setup page browser and scripts/build release first")
    browse = ["node", harness.REPO / "tests/page/bench.mjs", driver, chromium]
    harness.print_machine(given)
    with tempfile.TemporaryDirectory() as folder:
        trace = os.path.join(folder, "trace.csv")
        if given.changes > 0:
            harness.record(given.identify, trace)
            workbench = harness.Workbench(given.identify, trace)
            print("workbench:", flush=True)
            subprocess.run([*browse, "change", workbench.address, str(given.changes)], check=True)
            workbench.ended_after()
        if given.campaign > 0:
            harness.record(given.identify, trace, "8s", "1kHz")
            for count in (given.campaign // 4, given.campaign):
                make_campaign(trace, os.path.join(folder, f"runs{count}"), count)
                command = [given.identify, "--threads", "2", "--quiet", "--report", f"{count}.html", f"runs{count}"]
                uses = [harness.measured(command, cwd=folder) for _ in range(2)]
                print(f"campaign of {count} runs: "
                      + "; again, all there: ".join(f"{use.processor:.1f} s of processor time, {use.memory:.0f} MB" for use in uses)
                      + f"; page {os.path.getsize(os.path.join(folder, f'{count}.html')) / 1e6:.1f} MB", flush=True)
            subprocess.run([*browse, "open", os.path.join(folder, f"{given.campaign}.html")], check=True)

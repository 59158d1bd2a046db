// Every text of every page can be read at three widths, light, dark and on paper; contrast is enough and the keyboard
// reaches everything.
// usage: node layout_test.mjs DRIVER AXE CHROMIUM IDENTIFY FOLDER [few|all] [PAGE.html...]
//        few: the pages and sizes of the test suite; all: all of them. Pages that are named are taken as they are.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, rmSync } from "node:fs";
import { join } from "node:path";
import { launch } from "./browser.mjs";
import { axeFaults, settledLayout, textFaults, unreached } from "./layout.mjs";

const [driver, axe, chromium, identify, folder, extent = "all", ...named] = process.argv.slice(2);
const few = extent === "few";

function makePages() {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(join(folder, "runs"), { recursive: true });
  const run = (...words) => execFileSync(identify, words, { cwd: folder, stdio: ["ignore", "ignore", "inherit"] });
  const simulate = (name, radius, ...words) => run("simulate", "--radius", radius, "--noise-mu", "0.003", "--noise-v", "0.02mm/s",
    "--scatter", "0.004", "--rate", "2kHz", "--quiet", "--out", name, ...words);
  const page = (name, ...words) => {
    run(...words, "--quiet", "--report", `${name}.html`);
    pages.push(`${name}.html`);
  };
  const pages = [], record = ["--radius", "15mm", "--load", "50N", "hidden.csv"];
  simulate("hidden.csv", "15mm", "--duration", "32s", "--effect", "runout:A=0.05,phase=1rad", "--seed", "7");
  page("diagnosis", "diagnose", ...record);
  page("speed", "study", "speed", "--radius", "15mm", "--points", "12");
  if (few) return pages;
  page("map", "study", "map", "--radius", "15mm", "--x", "stiffness=8N/mm..20N/mm:8", "--y", "mass=0.5kg..1.5kg:8");
  page("trace", ...record);
  page("rig", "rig", ...record);
  page("twin", "twin", ...record);
  page("phase", "study", "phase", "--radius", "15mm", "--at", "2mm/s,6mm/s,500mm/s");
  page("response", "study", "response", "--radius", "15mm");
  page("sensitivity", "study", "sensitivity", "--radius", "15mm", "--points", "9");
  for (const radius of ["9", "12", "15"]) {
    for (const repeat of ["1", "2"]) {
      simulate(`runs/r${radius}mm_${repeat}.csv`, `${radius}mm`, "--duration", "6s", "--seed", radius + repeat);
    }
  }
  run("simulate", "--radius", "15mm", "--duration", "12s", "--rate", "2kHz", "--noise-mu", "0.006", "--noise-v", "0.1mm/s",
    "--scatter", "0.004", "--effect", "frictional-lag:tau=0.4ms", "--quiet", "--out", "lag.csv");
  page("plan", "plan", "--radius", "15mm", "--load", "50N", "--tap", "--speeds", "1rpm,8rpm", "lag.csv");
  run("simulate", "--kind", "velocity-steps", "--rate", "50Hz", "--duration", "140s", "--speed-steps",
    "0s:2um/s,20s:10um/s,50s:2um/s,90s:10um/s", "--rate-state", "a=0.01,b=0.015,D_c=8um,k=0.004/um,mu_0=0.6",
    "--noise-mu", "0.0002", "--quiet", "--out", "steps.csv");
  page("steps", "--kind", "velocity-steps", "steps.csv");
  page("batch", "runs", "--pattern", "r{radius}mm_{repeat}.csv", "--speed", "4rpm", "--load", "50N", "--share", "alpha");
  return pages;
}

const pages = named.length > 0 ? named : makePages();
const browser = await launch(driver, chromium, folder);
const faults = [];
try {
  for (const name of pages) {
    const { page } = await browser.open(name, 1280, { bypassCSP: true }); // axe-core is added to it
    const look = async (where, more = []) => {
      await settledLayout(page);
      faults.push(...[...await textFaults(page), ...more].map((fault) => `${name}, ${where}: ${fault}`));
    };
    for (const width of few ? [390, 1280] : [390, 768, 1280]) {
      await page.setViewportSize({ width, height: 900 });
      await page.reload(); // as a reader opens it there
      await look(`${width} px`);
    }
    await look("1280 px, axe", await axeFaults(page, axe));
    if (!few) faults.push(...(await unreached(page)).map((fault) => `${name}: ${fault}`));
    await page.emulateMedia({ colorScheme: "dark" });
    await look("dark", await axeFaults(page, axe, ["color-contrast"]));
    await page.emulateMedia({ media: "print", colorScheme: "light" });
    await page.setViewportSize({ width: 680, height: 1000 }); // A4 less its margins
    await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
    await look("on paper");
    await page.context().close();
  }
} finally {
  await browser.close();
}
assert.equal(faults.length, 0, `${faults.length} faults\n${faults.join("\n")}`);
console.log(`${pages.length} pages can be read`);

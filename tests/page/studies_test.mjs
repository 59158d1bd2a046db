// Reports of studies, twins and campaigns in Chromium, and the block on its disc in motion.
// usage: node studies_test.mjs DRIVER CHROMIUM IDENTIFY FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { launch } from "./browser.mjs";

const [driver, chromium, identify, folder] = process.argv.slice(2);
const run = (...words) => execFileSync(identify, words, { cwd: folder, stdio: ["ignore", "ignore", "inherit"] });

rmSync(folder, { recursive: true, force: true });
mkdirSync(join(folder, "runs"), { recursive: true });
const simulate = (radius, seed, out) => run("simulate", "--radius", radius, "--speed", "4rpm", "--duration", "6s", "--rate",
  "5kHz", "--noise-mu", "0.003", "--noise-v", "0.02mm/s", "--scatter", "0.004", "--seed", seed, "--quiet", "--out", out);
for (const radius of ["9mm", "15mm"]) for (const seed of ["1", "2"]) simulate(radius, seed, `runs/r${radius}_${seed}.csv`);
writeFileSync(join(folder, "table.csv"), "radius_mm,mu_s,mu_k\n9,0.521,0.388\n15,0.509,0.318\n");
const trace = ["--radius", "15mm", "--load", "50N", "runs/r15mm_1.csv"];
run("study", "speed", "--points", "8", "--quiet", "--report", "speed.html", ...trace);
run("study", "phase", "--at", "4rpm,20mm/s,600mm/s", "--quiet", "--report", "phase.html", ...trace);
run("study", "response", "--quiet", "--report", "response.html", ...trace);
run("study", "sensitivity", "--points", "5", "--quiet", "--report", "sensitivity.html", ...trace);
run("study", "map", "--quiet", "--report", "map.html", "--radius", "15mm", "--x", "stiffness=8N/mm..20N/mm:10", "--y",
  "mass=0.5kg..1.5kg:8");
run("twin", "--quiet", "--report", "twin.html", ...trace);
run("runs", "--pattern", "r{radius}_{repeat}.csv", "--load", "50N", "--speed", "4rpm", "--out", "results", "--quiet",
  "--compare", "table.csv", "--report", "campaign.html");

/** Every chart is drawn and has its units; nothing is wider than the screen. */
async function checkPage(page, name, least) {
  const charts = await page.evaluate(() => [...document.querySelectorAll(".plot")].map((plot) => {
    const layout = plot._fullLayout;
    const axes = Object.keys(layout).filter((key) => /^[xy]axis\d*$/.test(key)).map((key) => layout[key])
      .filter((axis) => !axis.ticktext).map((axis) => axis.title.text);
    return { id: plot.id, points: plot.data.length, axes };
  }));
  assert.ok(charts.length >= least, `${name}: ${charts.length} charts`);
  assert.equal(new Set(charts.map((chart) => chart.id)).size, charts.length, `${name}: ids are unique`);
  for (const chart of charts) {
    assert.ok(chart.points > 0, `${name}: ${chart.id} is empty`);
    for (const title of chart.axes) assert.match(title, /\[.+\]$|^run$/, `${name}: axis of ${chart.id}`);
  }
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${name}: ${wide} px wider than the screen`);
}

/** The block moves, stops, goes where the slider says, and sticks where it moves with the disc. */
async function checkAnimation(page, blocks) {
  const figure = page.locator("figure.animation").first();
  await figure.scrollIntoViewIfNeeded();
  assert.equal(await figure.locator("svg").count(), blocks);
  const place = () => figure.locator("svg rect").first().getAttribute("x").then(Number);
  const button = figure.locator("button").first();
  assert.equal(await button.textContent(), "Pause"); // it plays
  const before = await place();
  await page.waitForFunction((x) => Number(document.querySelector("figure.animation svg rect").getAttribute("x")) !== x, before);
  await button.press("Enter");
  assert.equal(await button.textContent(), "Play");
  const still = await place();
  await page.waitForTimeout(200);
  assert.equal(await place(), still);
  const slider = figure.locator("input[type=range]");
  await slider.focus();
  await page.keyboard.press("Home");
  await slider.fill("900"); // late in the loop: it sticks
  assert.match(await figure.locator("output").textContent(), /sticks/);
  await slider.fill("20");
  assert.match(await figure.locator("output").textContent(), /slips/);
  await figure.locator("select").selectOption("0.01");
}

const { open, close } = await launch(driver, chromium, folder);
try {
  const least = { speed: 3, phase: 7, response: 3, sensitivity: 10, map: 5, twin: 3, campaign: 12 };
  for (const [name, count] of Object.entries(least)) {
    const size = statSync(join(folder, `${name}.html`)).size;
    assert.ok(size < 4 << 20, `${name}: ${size} bytes`);
    // The others have charts of the same makers; scripts/check-pages opens all of them at every width.
    for (const width of ["phase", "map", "campaign"].includes(name) ? [1280, 390] : [1280]) {
      const { page, close: done } = await open(`${name}.html`, width);
      await checkPage(page, name, count);
      if (name === "twin" || name === "phase") await checkAnimation(page, 2);
      await done();
    }
    console.log(`${name}: ${size} bytes`);
  }
  const { page, close: done } = await open("twin.html", 1280, { reducedMotion: "reduce" });
  assert.equal(await page.locator("figure.animation button").first().textContent(), "Play"); // it waits
  await done();
  const campaign = await open("campaign.html", 1280);
  assert.match(await campaign.page.locator("#comparison").textContent(), /0\.5210/);
  await campaign.close();
} finally {
  await close();
}

// Opens reports in Chromium as a reader would and uses them.
// usage: node page_test.mjs DRIVER CHROMIUM IDENTIFY TRACE.csv FOLDER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { launch } from "./browser.mjs";

const [driver, chromium, identify, example, folder] = process.argv.slice(2);
const hostileName = "a<img src=x onerror=document.title='taken'>&b<b>.csv";

function makePages() {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const run = (...words) => execFileSync(identify, words, { cwd: folder, stdio: ["ignore", "ignore", "inherit"] });
  copyFileSync(example, join(folder, hostileName));
  run("--radius", "15mm", "--quiet", "--report", "trace.html", hostileName);
  run("simulate", "--radius", "15mm", "--speed", "4rpm", "--duration", "32s", "--rate", "2kHz", "--effect",
    "runout:A=0.05,phase=1rad", "--noise-mu", "0.003", "--noise-v", "0.02mm/s", "--seed", "7", "--out", "runout.csv");
  run("diagnose", "--radius", "15mm", "--speed", "4rpm", "--quiet", "--report", "diagnosis.html", "runout.csv");
}

/** Each chart has a title, axes with units, and its numbers behind a switch. */
async function checkCharts(page, least) {
  const charts = await page.evaluate(() => [...document.querySelectorAll("figure")].map((figure) => {
    const plot = figure.querySelector(".plot"), layout = plot._fullLayout;
    figure.querySelector("details.numbers").open = true;
    const axes = Object.keys(layout).filter((key) => /^[xy]axis\d*$/.test(key)).map((key) => layout[key]);
    return { id: plot.id, title: figure.querySelector("h3").textContent, points: plot.data.length,
      axes: axes.map((axis) => [Boolean(axis.ticktext), axis.title.text]), lines: plot.querySelectorAll("path").length };
  }));
  assert.ok(charts.length >= least, `${charts.length} charts`);
  assert.equal(new Set(charts.map((chart) => chart.id)).size, charts.length, "ids are unique");
  for (const chart of charts) {
    assert.ok(chart.title && chart.points > 0 && chart.lines > 0, chart.id);
    for (const [named, title] of chart.axes) {
      if (!named && title !== "cycle") assert.match(title, /\[.+\]$/, `axis of ${chart.id}`);
    }
  }
  await page.waitForFunction(() => [...document.querySelectorAll("details.numbers")]
    .every((details) => details.querySelectorAll("tbody tr").length > 0));
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `${wide} px wider than the screen`);
}

const range = (page, id) => page.evaluate((name) => document.getElementById(name)._fullLayout.xaxis.range.slice(), id);

async function checkHoverAndZoom(page) {
  const plot = page.locator("#t1-cycles");
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.locator(".nsewdrag").first().boundingBox();
  const sample = await page.evaluate(() => {
    const { data, _fullLayout } = document.getElementById("t1-cycles");
    const k = Math.floor(data[0].x.length / 2);
    return [_fullLayout.xaxis.l2p(data[0].x[k]), _fullLayout.yaxis.l2p(data[0].y[k])];
  });
  await page.mouse.move(box.x + sample[0] - 3, box.y + sample[1]);
  await page.mouse.move(box.x + sample[0], box.y + sample[1]);
  await page.waitForSelector("#t1-cycles .hoverlayer .hovertext");
  assert.match(await page.locator("#t1-cycles .hoverlayer").textContent(), / s.*μ/);

  const before = await range(page, "t1-cycles");
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height, { steps: 5 });
  await page.mouse.up();
  const part = (await range(page, "t1-cycles")).reduce((low, high) => high - low) / (before[1] - before[0]);
  assert.ok(Math.abs(part - 0.2) < 0.02, `a drag over a fifth shows ${part}`);
  await plot.focus();
  await page.keyboard.press("0");
  assert.deepEqual(await range(page, "t1-cycles"), before);
  await page.keyboard.press("+");
  await page.keyboard.press("ArrowRight");
  const [low, high] = await range(page, "t1-cycles"), width = before[1] - before[0];
  assert.ok(Math.abs((high - low) / width - 0.5) < 1e-6 && low > before[0] + 0.25 * width, "keys zoom and move");
}

async function checkLegend(page) {
  const button = page.locator("figure:has(#t1-law) .legend button").filter({ hasText: "slowing down" });
  const visible = () => page.evaluate(() => document.getElementById("t1-law").data
    .filter((trace) => trace.legendgroup === "measured, slowing down").map((trace) => trace.visible ?? true));
  assert.deepEqual(await visible(), [true, true]); // the band and its line
  await button.click();
  assert.equal(await button.getAttribute("aria-pressed"), "false");
  assert.deepEqual(await visible(), ["legendonly", "legendonly"]);
  await button.press("Enter");
  assert.deepEqual(await visible(), [true, true]);
}

/** A band goes along its upper edge and back along the lower one, and leaves out where it has a gap. */
async function checkBand(page) {
  const bands = await page.evaluate(() => {
    const line = { name: "a", stroke: { colour: "blue" }, x: [0, 1, 2, 3, 4], low: [1, 2, null, 4, 5], high: [2, 3, null, 5, 6] };
    const unknown = { ...line, low: line.x.map(() => null) };
    return [line, unknown].map((one) => bandOf(one, {})).map(({ x, y }) => x.map((at, k) => [at, y[k]]));
  });
  const gap = [null, null];
  assert.deepEqual(bands, [[[0, 2], [1, 3], [1, 2], [0, 1], gap, [3, 5], [4, 6], [4, 5], [3, 4], gap], []]);
}

async function checkSaving(page) {
  const saved = async (selector) => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator(selector).first().click()]);
    return readFileSync(await download.path());
  };
  const svg = (await saved('button[aria-label^="Save as SVG: Friction over"]')).toString();
  assert.match(svg, /^<svg[\s\S]*Friction over relative velocity[\s\S]*<\/svg>$/);
  const png = await saved('button[aria-label^="Save as PNG: Friction over"]');
  assert.deepEqual([...png.subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47]);
  assert.equal(png.readUInt32BE(16), 2700);
  const csv = (await saved("figure:has(#t1-spectrum) details button")).toString();
  assert.match(csv, /^line,frequency \[Hz\],quantity,value,low,high\namplitude,0,amplitude of v_r \[mm\/s\],/);
}

async function checkNames(page) {
  assert.equal(await page.locator("h1").textContent(), hostileName);
  assert.ok((await page.title()).startsWith(hostileName));
  assert.equal(await page.locator("img").count(), 0);
}

/** A table without numbers keeps its columns, too. */
async function checkTables(page) {
  const names = await page.evaluate(() => {
    const table = [...document.querySelectorAll("table")].find((one) => one.caption?.textContent === "Health of the data");
    return [...table.querySelectorAll("thead th")].map((cell) => cell.textContent);
  });
  assert.deepEqual(names, ["check", "status", "what was found"]);
}

/** Every sample that the trace holds lies within what is drawn of the whole record: no peak is lost. */
async function checkPeaks(page) {
  const rows = readFileSync(example, "utf8").split(/\r?\n/).map((line) => line.split(/[,;\t]/).map(Number))
    .filter((row) => row.length > 1 && row.every(Number.isFinite));
  const drawn = await page.evaluate(() => {
    const y = document.getElementById("t1-record").data[0].y.filter((value) => value !== null);
    return [Math.min(...y), Math.max(...y)];
  });
  const column = rows[0].map((_, k) => rows.map((row) => row[k])).map((values) => [values.reduce((a, b) => Math.min(a, b)),
    values.reduce((a, b) => Math.max(a, b))]);
  const close = (a, b) => Math.abs(a - b) <= 2e-5 * Math.abs(b);
  assert.ok(column.some(([low, high]) => close(drawn[0], low) && close(drawn[1], high)), `friction from ${drawn}`);
}

/** On paper everything is drawn, and no wider than the paper. */
async function checkPrint(page) {
  const pdf = await page.pdf({ format: "A4" });
  assert.ok(pdf.length > 50000, `${pdf.length} bytes of PDF`);
  writeFileSync(join(folder, "print.pdf"), pdf);
}

/** A script that is not the page's own does not run. */
async function checkPolicy(page) {
  await page.evaluate(() => {
    const script = document.createElement("script");
    script.textContent = "window.foreign = true";
    document.body.append(script);
  });
  assert.equal(await page.evaluate(() => window.foreign), undefined);
}

makePages();
const { open, close: closeBrowser } = await launch(driver, chromium, folder);
try {
  for (const width of [1280, 390]) {
    const { page, close } = await open("trace.html", width);
    await checkCharts(page, 12);
    await checkNames(page);
    await checkTables(page);
    if (width === 1280) {
      await checkHoverAndZoom(page);
      await checkLegend(page);
      await checkBand(page);
      await checkSaving(page);
      await checkPeaks(page);
      await checkPrint(page);
    }
    await close();
  }
  for (const width of [1280, 390]) {
    const { page, close } = await open("diagnosis.html", width);
    await checkCharts(page, 15);
    assert.match(await page.locator(".verdict").textContent(), /runout/);
    const ladder = await page.evaluate(() => document.getElementById("ladder").data[0].y);
    assert.ok(ladder.length === 2 && ladder[1] < ladder[0] / 2, `the ladder falls: ${ladder}`);
    await close();
  }
  const { page } = await open("trace.html", 1280);
  await checkPolicy(page); // which the browser complains of
  console.log("the page works");
} finally {
  await closeBrowser();
}

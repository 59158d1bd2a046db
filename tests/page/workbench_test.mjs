// Uses the workbench in Chromium as a person would.
// usage: node workbench_test.mjs DRIVER CHROMIUM IDENTIFY FOLDER
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { lookAtAll } from "./browser.mjs";

const [driver, chromium, identify, folder] = process.argv.slice(2);
const playwright = await import(pathToFileURL(driver));
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const run = (...words) => execFileSync(identify, words, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "inherit"] });
run("simulate", "--radius", "15mm", "--speed", "4rpm", "--duration", "10s", "--rate", "5kHz", "--effect",
  "frictional-lag:tau=4ms", "--noise-mu", "0.003", "--noise-v", "0.02mm/s", "--seed", "7", "--out", "lag.csv");

run("simulate", "--radius", "15mm", "--duration", "4s", "--rate", "2kHz", "--noise-mu", "0.01", "--noise-v", "0.1mm/s",
  "--scatter", "0.004", "--effect", "frictional-lag:tau=0.25ms", "--seed", "4", "--out", "doubtful.csv");

const servers = [];
process.on("exit", () => servers.forEach((server) => server.kill("SIGKILL"))); // where a check failed

/** Starts the server; resolves with its address once it is printed. */
async function explore(...words) {
  const server = spawn(identify, ["explore", ...words], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  servers.push(server);
  let said = "";
  const address = await new Promise((resolve, reject) => {
    server.stdout.on("data", (data) => {
      said += data;
      const found = said.match(/http:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]{32}/);
      if (found) resolve(found[0]);
    });
    server.on("exit", (code) => reject(new Error(`explore ended with ${code}`)));
  });
  const ended = new Promise((resolve) => server.on("exit", (code) => resolve(code)));
  return { server, address, ended };
}

const browser = await playwright.chromium.launch({ executablePath: chromium,
  args: process.getuid() === 0 ? ["--no-sandbox"] : [] });

/** A page in which any complaint of the browser, and any address but the server's, fails the test. */
async function open(address, width) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, acceptDownloads: true });
  const page = await context.newPage();
  page.setDefaultTimeout(60000);
  const complaints = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.stack));
  const origin = new URL(address).origin;
  page.on("request", (request) => {
    if (!request.url().startsWith(`${origin}/`) && !/^(data|blob):/.test(request.url())) complaints.push(request.url());
  });
  await page.goto(address);
  await settled(page);
  return { page, complaints, close: () => context.close() };
}

const settled = (page) => page.waitForFunction(() => document.documentElement.dataset.workbench === "settled" &&
  document.documentElement.dataset.drawn === "all");
/** Does something and waits for the picture of the model it leads to. */
async function change(page, action) {
  await page.evaluate(() => { document.documentElement.dataset.workbench = "waiting"; });
  await action();
  await settled(page);
}
const shownError = async (page) => Number.parseFloat(await page.textContent("#shown-error"));

/** The row of the model shown is marked, has its error, and its bar is as much shorter as the error is smaller. */
async function checkLadder(page, before, after) {
  const rows = await page.evaluate(() => [...document.querySelectorAll("#workbench-rungs tbody tr")].map((row) => ({
    current: row.className === "current", model: row.querySelector("button").textContent,
    error: Number.parseFloat(row.cells[2].textContent), bar: row.querySelector(".bar").getBoundingClientRect().width })));
  const [shown, ...others] = rows.filter((row) => row.current), bare = rows.find((row) => row.error === before);
  assert.ok(shown && others.length === 0 && /frictional-lag/.test(shown.model) && shown.error === after, JSON.stringify(rows));
  assert.ok(Math.abs(shown.bar / bare.bar - after / before) < 0.03, `bars of ${shown.bar} and ${bare.bar} px`);
}

/** A formula that does not parse is refused with its reason, where it stands, and the page lives on. */
async function refuseFormula(page) {
  await page.fill("#workbench-formula", "hump = a*exp(-v; a=0.02");
  await page.click("#apply-formula");
  await page.waitForSelector("#formula-trouble:not([hidden])");
  assert.match(await page.textContent("#formula-trouble"), /formula/);
  assert.equal(await page.isHidden("#workbench-trouble"), true);
  await page.fill("#workbench-formula", "hump = a*exp(-v/w); a=0.02, w=6mm/s");
  await change(page, () => page.click("#apply-formula"));
  assert.equal(await page.isHidden("#formula-trouble"), true);
}

/** The hidden effect is switched on and the error falls; then everything else that a person can change. */
async function watchTheErrorFall(address, width) {
  const { page, complaints, close } = await open(address, width);
  const before = await shownError(page);
  if (!await page.isVisible("#effect-frictional-lag")) await page.locator("summary", { hasText: "What the contact does" }).click();
  await change(page, () => page.check("#effect-frictional-lag"));
  const after = await shownError(page);
  console.log(`at ${width} px the held-out error falls from ${before} to ${after}; answered after ` +
    `${await page.evaluate(() => document.documentElement.dataset.answerMs)} ms`);
  assert.ok(after < 0.75 * before, `the error fell from ${before} to ${after} only`);
  await checkLadder(page, before, after);
  await page.screenshot({ path: join(folder, `lag-${width}.png`), fullPage: false });

  // The command shown gives the same number.
  const command = await page.textContent("#workbench-command");
  execFileSync("sh", ["-c", `${command.replace(/^identify/, `'${identify}'`)} --quiet --json same.json`], { cwd: folder });
  const fit = JSON.parse(readFileSync(join(folder, "same.json"), "utf8")).fits[0];
  assert.equal(Number(fit.error.held_out_rmse.toPrecision(4)), after);

  // Back by a click, with the same number.
  await change(page, () => page.locator("#workbench-rungs button").first().click());
  assert.equal(await shownError(page), before);
  assert.equal(await page.isChecked("#effect-frictional-lag"), false);

  // A start dragged with the keyboard, bounds, cycles and a stretch that is left out.
  const unfold = (title) => page.locator("#workbench-controls > details > summary", { hasText: title }).click();
  await unfold("Parameters");
  await change(page, async () => {
    await page.click(".parameter[data-name=mu_s] summary");
    await page.focus("#slide-start-mu_s");
    await page.keyboard.press("ArrowRight");
  });
  assert.match(await page.textContent("#workbench-command"), /--start mu_s=/);
  await change(page, () => page.fill("#upper-mu_s", "0.45").then(() => page.keyboard.press("Enter")));
  assert.match(await page.textContent("#workbench-command"), /--bounds mu_s=/);
  assert.match(await page.textContent(".parameter[data-name=mu_s] [data-value]"), /at its bound/);
  await change(page, () => page.click(".parameter[data-name=mu_s] button"));
  assert.doesNotMatch(await page.textContent("#workbench-command"), /--bounds|--start/);
  await page.waitForFunction(() => JSON.parse(document.documentElement.dataset.byHand || "{}").mu_s > 0);
  await unfold("Part of the record");
  await change(page, () => page.fill("#cycles-to", "20").then(() => page.keyboard.press("Enter")));
  assert.match(await page.textContent("#workbench-command"), /--cycles 0\.\.20/);
  await page.fill("#exclude-from", "1");
  await page.fill("#exclude-to", "1.2");
  await change(page, () => page.click("#exclude"));
  assert.match(await page.textContent("#workbench-command"), /--exclude 1s\.\.1\.2s/);

  await unfold("An effect of your own");
  await refuseFormula(page);
  const unexpected = complaints.filter((text) => !/422/.test(text));
  assert.deepEqual(unexpected, [], `complaints at ${width} px`);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(overflow <= 0, `the page is ${overflow} px wider than ${width} px`);
  await lookAtAll(page);
  await page.screenshot({ path: join(folder, `all-${width}.png`), fullPage: true });
  await close();
}

/** On the first screen stand the picture, the ladder with the current model, and the effects; a stretch is brushed away. */
async function firstScreen(address) {
  const { page, complaints, close } = await open(address, 1280);
  for (const what of ["#t1-law .main-svg", "#workbench-rungs .current", "#effect-frictional-lag", "#workbench-diagnose"]) {
    const box = await page.locator(what).first().boundingBox();
    assert.ok(box && box.y >= 0 && box.y + Math.min(box.height, 400) < 900, `${what} is on the first screen: ${JSON.stringify(box)}`);
  }
  await page.screenshot({ path: join(folder, "first-1280.png") });
  const plot = page.locator("#t1-record");
  await plot.scrollIntoViewIfNeeded();
  await page.locator("figure:has(#t1-record) .brush").click();
  await page.evaluate(() => redraw(chartItems.get("t1-record"), null)); // as a refined fit does
  const area = await plot.locator(".nsewdrag").first().boundingBox();
  await change(page, async () => {
    await page.mouse.move(area.x + 0.4 * area.width, area.y + 30);
    await page.mouse.down();
    await page.mouse.move(area.x + 0.5 * area.width, area.y + 40, { steps: 4 });
    await page.mouse.up();
  });
  assert.match(await page.textContent("#workbench-command"), /--exclude 3\.9\d*s\.\.[45]\.\d*s|--exclude 4\.?\d*s\.\.[45]\.?\d*s/);
  await change(page, () => page.click("#workbench-undo"));
  assert.doesNotMatch(await page.textContent("#workbench-command"), /--exclude/);
  assert.deepEqual(complaints, []);
  await close();
}

/** Charts wait until somebody comes near; then each shows the model in view, and is never made anew. */
async function chartsUpToDate(address) {
  const { page, complaints, close } = await open(address, 1280);
  const charts = () => page.evaluate(() => [...chartItems.values()].map(({ chart, shown: as, plot }) => {
    const values = (trace) => JSON.stringify([trace.x, trace.y, trace.z]);
    const drawn = as !== "", shown = drawn ? new Set(plot.data.map(values)) : null;
    const described = [...chart.lines.filter((line) => line.y.length), ...(chart.map ? [chart.map] : [])];
    return { id: chart.id, drawn, right: drawn && described.every((line) => shown.has(values(line))) };
  }));
  const drawnOf = (list) => list.filter((chart) => chart.drawn).map((chart) => chart.id);
  const wrongOf = (list) => list.filter((chart) => chart.drawn && !chart.right).map((chart) => chart.id);
  const opened = await charts();
  assert.ok(drawnOf(opened).includes("t1-law") && !drawnOf(opened).includes("t1-spectrum"), drawnOf(opened).join());
  await page.evaluate(() => { window.lawFigure = document.querySelector("figure:has(#t1-law)"); });
  await change(page, () => page.check("#effect-viscous"));
  const changed = await charts();
  assert.deepEqual([drawnOf(changed), wrongOf(changed)], [drawnOf(opened), []]);
  await lookAtAll(page);
  await settled(page);
  const seen = await charts();
  assert.deepEqual([drawnOf(seen), wrongOf(seen)], [seen.map((chart) => chart.id), []]);
  const error = await page.evaluate(() => JSON.stringify(document.getElementById("t1-error-time").data[0].y));
  await change(page, () => page.check("#effect-frictional-lag"));
  const after = await charts(), wrong = wrongOf(after);
  assert.ok(!wrong.includes("t1-law") && wrong.includes("t1-error-time"), `left as they were: ${wrong}`);
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  assert.deepEqual(wrongOf(await charts()), [], "on paper");
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
  await change(page, () => page.uncheck("#effect-viscous"));
  assert.ok(wrongOf(await charts()).includes("t1-error-time"));
  const switched = await page.evaluate(() => {
    document.querySelector("figure:has(#t1-error-time) .legend button").click();
    return document.getElementById("t1-error-time").data[0].visible;
  });
  assert.equal(switched, "legendonly", "what is switched is the model in view");
  assert.ok(!wrongOf(await charts()).includes("t1-error-time"));
  await page.emulateMedia({ colorScheme: "dark" });
  assert.equal(await page.locator(".verdict").count(), 1);
  await page.locator("#t1-error-speed").scrollIntoViewIfNeeded();
  await page.waitForFunction(() => !waiting.some((item) => item.plot.id === "t1-error-speed"));
  await lookAtAll(page);
  assert.deepEqual(wrongOf(await charts()), []);
  assert.notEqual(await page.evaluate(() => JSON.stringify(document.getElementById("t1-error-time").data[0].y)), error);
  assert.ok(await page.evaluate(() => window.lawFigure === document.querySelector("figure:has(#t1-law)")));
  assert.deepEqual(complaints, []);
  await close();
}

/** Another page of the same session: its own choice, the same ladder. */
async function twoAtOnce(address) {
  const [a, b] = await Promise.all([open(address, 1280), open(address, 1280)]);
  await Promise.all([change(a.page, () => a.page.check("#law-fractional")), change(b.page, () => b.page.check("#effect-viscous"))]);
  assert.match(await a.page.textContent("#shown-model"), /^fractional$/);
  assert.match(await b.page.textContent("#shown-model"), /viscous/);
  assert.deepEqual([...a.complaints, ...b.complaints], []);
  await Promise.all([a.close(), b.close()]);
}

async function diagnose(address) {
  const { page, complaints, close } = await open(address, 1280);
  await page.click("#workbench-diagnose");
  await page.waitForFunction(() => document.documentElement.dataset.diagnosis === "running");
  await page.click("#workbench-cancel");
  await page.waitForFunction(() => document.documentElement.dataset.diagnosis === "cancelled");
  await page.click("#workbench-diagnose");
  await page.waitForFunction(() => document.documentElement.dataset.diagnosis === "done", null, { timeout: 120000 });
  await change(page, () => page.click("#take-finding"));
  assert.match(await page.textContent("#shown-model"), /lag/);
  // What was found and the model that it opens show the same numbers.
  const ladder = await page.locator("#workbench-finding tbody tr").allTextContents();
  assert.ok(ladder.at(-2).includes(await page.textContent("#shown-error")), `${ladder} and ${await shownError(page)}`);
  await change(page, () => page.click("#workbench-undo"));
  assert.doesNotMatch(await page.textContent("#shown-model"), /lag/);
  await change(page, () => page.click("#take-finding"));
  await page.reload();
  await settled(page);
  assert.match(await page.textContent("#shown-model"), /lag/, "a reload goes on where the page was");
  await page.locator("#workbench-controls > details > summary", { hasText: "The same from the command line" }).click();
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#workbench-save")]);
  const file = join(folder, "session.json");
  await download.saveAs(file);
  assert.ok(JSON.parse(readFileSync(file, "utf8")).rungs.length > 3);
  assert.deepEqual(complaints, []);
  await close();
}

/** Where a record leaves a group open, the runs that could distinguish it stand beside it; a reload keeps them. */
async function planBesideTheGroup(address) {
  const { page, complaints, close } = await open(address, 1280);
  const done = () => page.waitForFunction(() => document.documentElement.dataset.diagnosis === "done", null, { timeout: 120000 });
  await page.click("#workbench-diagnose");
  await page.waitForSelector("#workbench-plan-runs", { timeout: 120000 });
  await page.click("#workbench-plan-runs");
  await page.waitForFunction(() => document.documentElement.dataset.diagnosis === "running");
  await page.click("#workbench-cancel");
  await page.waitForFunction(() => document.documentElement.dataset.diagnosis !== "running");
  assert.equal(await page.locator("#workbench-plan table").count(), 0, "a plan that was cancelled shows no experiments");
  await page.click("#workbench-plan-runs");
  await page.waitForFunction(() => document.documentElement.dataset.diagnosis === "running");
  await done();
  const box = page.locator("#workbench-plan");
  assert.match(await box.textContent(), /Open: .*frictional-lag \(\d+ %\)/);
  assert.ok(await box.locator("tbody tr").count() > 2);
  assert.ok(await box.locator(".main-svg").count() > 0, "what each model predicts is drawn");
  await page.reload();
  await settled(page);
  await done();
  assert.match(await page.textContent("#workbench-plan"), /Open: /);
  assert.equal(await page.locator("#workbench-plan-runs").count(), 0, "the button is gone where the plan stands");
  assert.deepEqual(complaints, []);
  await close();
}

/** The server ends while a page waits: within two seconds, and the page says so. */
async function stopInMidFit({ server, address, ended }) {
  const { page, close } = await open(address, 1280);
  // So long a formula that no machine fits it, not even to the reduced record, before the signal arrives.
  const powers = Array.from({ length: 100 }, (_, i) => `k*(v/w)^.${i + 10}`).join("+");
  const asked = page.waitForRequest((request) => request.url().endsWith("/api/show") &&
    request.postDataJSON().choice.formulas.length === 1);
  await page.locator("#workbench-controls > details > summary", { hasText: "An effect of your own" }).click();
  await page.fill("#workbench-formula", `long = ${powers}; k=0.001, w=6mm/s`);
  await page.click("#apply-formula");
  const request = await asked;
  const begin = performance.now();
  server.kill("SIGTERM");
  assert.equal(await ended, 0);
  assert.ok(performance.now() - begin < 2000, "the server took more than two seconds to end");
  const response = await request.response();
  const given = response === null ? {} : await response.json().catch(() => ({}));
  assert.ok(response === null || given.superseded, "the fit was over before the server ended");
  await page.check("#effect-viscous");
  await page.waitForSelector("#workbench-trouble:not([hidden])");
  assert.match(await page.textContent("#workbench-trouble"), /does not answer/);
  await close();
}

/** With twice the radius at half the speed the record is read anew, and everything but the command is as before. */
async function changeRadius(address) {
  const { page, close } = await open(address, 1280);
  assert.ok(await page.isChecked("#law-exponential"));
  const alpha = async () => Number.parseFloat(await page.textContent('[data-value="alpha"]'));
  const before = await alpha(), error = await shownError(page);
  await page.locator("#workbench-controls > details > summary", { hasText: "Radius, speed and load" }).click();
  assert.equal(await page.inputValue("#condition-radius"), "15 mm");
  await page.fill("#condition-radius", "fifteen");
  await page.click("#apply-conditions");
  await page.waitForSelector("#workbench-trouble:not([hidden])");
  assert.match(await page.textContent("#workbench-trouble"), /radius/);
  await page.fill("#condition-radius", "30mm");
  await page.fill("#condition-speed", "2rpm"); // the same speed under the block
  await Promise.all([page.waitForNavigation(), page.click("#apply-conditions")]);
  await settled(page);
  assert.match(await page.textContent("#workbench-command"), /--radius 30mm --speed 2rpm/);
  assert.ok(Math.abs(await alpha() / before - 1) < 1e-3, `alpha ${before} became ${await alpha()}`);
  assert.ok(Math.abs(await shownError(page) / error - 1) < 1e-3);
  await page.locator("#workbench-controls > details > summary", { hasText: "Radius, speed and load" }).click();
  await page.fill("#condition-radius", "15mm");
  await page.fill("#condition-speed", "");
  await Promise.all([page.waitForNavigation(), page.click("#apply-conditions")]);
  await settled(page);
  await close();
}

const begun = await explore("--radius", "15mm", "lag.csv");
for (const width of [1280, 390]) await watchTheErrorFall(begun.address, width);
await firstScreen(begun.address);
await chartsUpToDate(begun.address);
await twoAtOnce(begun.address);
await diagnose(begun.address);
const { page: stranger, close } = await open(begun.address, 1280);
const refused = await stranger.goto(begun.address.replace(/token=.*/, "token=0"));
assert.equal(refused.status(), 403);
await close();
await changeRadius(begun.address); // which begins a new ladder
await stopInMidFit(begun);
const again = await explore("--session", "session.json");
const { page: restored, close: closeRestored } = await open(again.address, 1280);
assert.ok(await restored.locator("#workbench-rungs tbody tr").count() > 3);
await closeRestored();
again.server.kill("SIGINT");
assert.equal(await again.ended, 0);
const doubtful = await explore("--radius", "15mm", "--load", "50N", "doubtful.csv");
await planBesideTheGroup(doubtful.address);
doubtful.server.kill("SIGTERM");
assert.equal(await doubtful.ended, 0);
await browser.close();
console.log("the workbench: all as it should be");

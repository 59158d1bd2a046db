// Times pages in Chromium as a person sees them. usage:
// node bench.mjs DRIVER CHROMIUM open FILE [TIMES]          a report: until its words are painted, until it answers (the
//                                                           charts in view are drawn by then), and until all are drawn
// node bench.mjs DRIVER CHROMIUM change ADDRESS [CHANGES]   the workbench: from the click on an effect (a third one beside two
//                                                           others) to the answer and the charts in view shown, and to the
//                                                           whole page updated: the charts near the view too, on the page as
//                                                           it opens, and on one whose charts have all been looked at; then,
//                                                           after such a change, from a jump to a chart farther down until
//                                                           it is up to date
import { pathToFileURL } from "node:url";
import { lookAtAll } from "./browser.mjs";

const [driver, chromium, what, where, count] = process.argv.slice(2);
const playwright = await import(pathToFileURL(driver));
const browser = await playwright.chromium.launch({ executablePath: chromium,
  args: process.getuid() === 0 ? ["--no-sandbox"] : [] });
const context = await browser.newContext({ viewport: { width: 1400, height: 900 } });
const middle = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];
const show = (list) => `${Math.round(middle(list))} ms (slowest ${Math.round(Math.max(...list))})`;
const drawn = () => document.documentElement.dataset.drawn === "all";

async function open(address, times) {
  const painted = [], answered = [], whole = [];
  for (let k = 0; k < times; ++k) {
    const page = await context.newPage();
    const began = performance.now(), beganAt = Date.now();
    await page.goto(address, { waitUntil: "commit" });
    await page.waitForSelector("main section h2");
    answered.push(performance.now() - began);
    painted.push(await page.evaluate(() =>
      performance.timeOrigin + performance.getEntriesByName("first-contentful-paint")[0].startTime) - beganAt);
    await page.waitForFunction(drawn, undefined, { polling: 5 });
    whole.push(performance.now() - began);
    await page.close();
  }
  console.log(`words painted after ${show(painted)}, answers after ${show(answered)}, every chart drawn after ${show(whole)}; ${times} times`);
}

/** Clicks the box of an effect; resolves, in the page, with when its answer was shown and when all was drawn [ms]. */
const click = (page, name) => page.evaluate((name) => new Promise((resolve) => {
  const state = document.documentElement.dataset, began = performance.now();
  let shown = 0;
  state.workbench = "waiting";
  document.querySelector(`input[name=effect][value="${name}"]`).click();
  const look = () => {
    const now = performance.now() - began;
    if (state.workbench === "failed" || now > 60000) return resolve(null);
    if (!shown && ["shown", "settled"].includes(state.workbench)) shown = now;
    if (shown && state.drawn === "all") return resolve({ name, shown, drawn: now });
    setTimeout(look, 1);
  };
  setTimeout(look, 0);
}), name);

/** Times so many changes, with models that were not visited before where `from` goes on. */
async function timesOf(page, names, changes, from) {
  const times = [];
  let k = from;
  for (; times.length < changes && k < from + 3 * changes; ++k) {
    const three = [0, 1, 2].map((i) => names[(k * 7 + i * (3 + k)) % names.length]);
    if (new Set(three).size < 3) continue;
    const ends = [];
    for (const name of three) ends.push(await click(page, name));
    if (ends[2]) times.push({ ...ends[2], name: three.join(" + ") });
    for (const name of three) await click(page, name);
  }
  return { times, next: k };
}

async function change(address, changes) {
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  await page.goto(address);
  await page.waitForFunction(() => document.documentElement.dataset.workbench === "settled");
  await page.waitForFunction(drawn);
  const names = await page.evaluate(() => [...document.querySelectorAll("input[name=effect]:not(:disabled)")].map((box) => box.value));
  let from = 0;
  for (const state of ["as it opens", "with every chart looked at"]) {
    if (from > 0) await lookAtAll(page);
    const charts = await page.evaluate(() => document.querySelectorAll(".plot .main-svg:first-child").length);
    const { times, next } = await timesOf(page, names, changes, from);
    from = next;
    const slowest = times.reduce((a, b) => (b.drawn > a.drawn ? b : a));
    console.log(`page ${state} (${charts} charts drawn): answer and charts in view after ${show(times.map((t) => t.shown))}, whole page after ` +
      `${show(times.map((t) => t.drawn))}; ${times.length} clicks, the slowest on ${slowest.name}`);
  }
  const jumps = [];
  for (let k = 0; k < 10; ++k) {
    await click(page, names[k]);
    jumps.push(await jump(page));
    await page.evaluate(() => scrollTo(0, 0));
    await page.waitForFunction(drawn);
    await click(page, names[k]);
  }
  console.log(`a chart far from view is up to date ${show(jumps)} after a jump to it; ${jumps.length} times`);
}

/** Jumps to the first chart that was left as it was; resolves with when no chart in view is left so [ms]. */
const jump = (page) => page.evaluate(() => new Promise((resolve) => {
  const began = performance.now();
  (waiting.find((item) => item.shown !== "") || waiting[0]).plot.scrollIntoView();
  const look = () => {
    if (!waiting.some((item) => isWithin(item, 0))) return resolve(performance.now() - began);
    setTimeout(look, 1);
  };
  setTimeout(look, 0);
}));

await (what === "open" ? open(pathToFileURL(where).href, Number(count || 5)) : change(where, Number(count || 40)));
await browser.close();

// Opens pages in Chromium and takes note of everything the browser complains of.
import assert from "node:assert/strict";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

export async function launch(driver, chromium, folder) {
  const playwright = await import(pathToFileURL(driver));
  const browser = await playwright.chromium.launch({ executablePath: chromium,
    args: process.getuid() === 0 ? ["--no-sandbox"] : [] });

  /** A page in which any complaint of the browser, and any address but the file's own, fails the test. */
  async function open(name, width, more = {}) {
    const context = await browser.newContext({ viewport: { width, height: 900 }, acceptDownloads: true, ...more });
    const page = await context.newPage();
    page.setDefaultTimeout(120000);
    const complaints = [];
    page.on("console", (message) => ["error", "warning"].includes(message.type()) && complaints.push(message.text()));
    page.on("pageerror", (error) => complaints.push(error.stack));
    page.on("dialog", (dialog) => complaints.push(dialog.message()));
    const address = pathToFileURL(join(folder, name)).href;
    page.on("request", (request) => {
      if (request.url() !== address && !/^(data|blob):/.test(request.url())) complaints.push(request.url());
    });
    await page.goto(address);
    await lookAtAll(page);
    const close = async () => {
      assert.deepEqual(complaints, [], `complaints of ${name} at ${width} px`);
      await context.close();
    };
    return { page, close };
  }
  return { open, close: () => browser.close() };
}

/** Scrolls past every chart, which draws those that wait for it, and back to the top. */
export async function lookAtAll(page) {
  await page.evaluate(async () => {
    for (let y = 0; y < document.documentElement.scrollHeight; y += innerHeight / 2) {
      scrollTo(0, y);
      await new Promise((go) => requestAnimationFrame(() => setTimeout(go, 20)));
    }
    scrollTo(0, 0);
  });
  await page.waitForFunction(() => document.documentElement.dataset.drawn === "all");
}

// What a person could not read on a page: texts that are cut, lie over each other or reach beyond the page, words broken
// in the middle, too little contrast, and what the keyboard does not reach.

import { lookAtAll } from "./browser.mjs";

// The first four run in the page.

function nameOf(element) {
  const named = element.closest("[id]");
  return `${named ? `#${named.id}` : ""} ${element.tagName.toLowerCase()}.${element.getAttribute("class") || ""}`;
}

/** The nearest element about this one for which its style says so. */
function about(element, holds) {
  for (let at = element; at && at !== document.body; at = at.parentElement) if (holds(getComputedStyle(at))) return at;
  return null;
}

/** Every text that is shown, with its boxes and what it scrolls in. */
function shownTexts() {
  const texts = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    if (!node.data.trim() || element.closest("script, style, noscript, textarea, option, .skip, .visually-hidden")) continue;
    if (!element.checkVisibility({ checkOpacity: true, checkVisibilityCSS: true })) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    const rects = [...range.getClientRects()].filter((rect) => rect.width > 0.5 && rect.height > 0.5);
    const scroller = about(element, (style) => /auto|scroll/.test(style.overflowX + style.overflowY));
    const broken = [];
    for (const word of element.closest("h1, pre, code, svg") ? [] : node.data.matchAll(/[\p{L}\p{N}]{2,}/gu)) {
      range.setStart(node, word.index);
      range.setEnd(node, word.index + word[0].length);
      const tops = new Set([...range.getClientRects()].filter((rect) => rect.width > 0).map((rect) => Math.round(rect.top)));
      if (tops.size > 1) broken.push(word[0]);
    }
    if (rects.length > 0) texts.push({ text: node.data.trim(), element, rects, scroller, broken });
  }
  return texts;
}

/** Texts that lie over each other. Boxes of text in drawings are taller than their letters. */
function overlaps(texts) {
  const found = [], boxes = [];
  for (const one of texts) {
    const clip = one.scroller && one.scroller.getBoundingClientRect();
    for (const rect of one.rects) {
      const hidden = clip && (rect.right <= clip.left || rect.left >= clip.right || rect.bottom <= clip.top || rect.top >= clip.bottom);
      if (!hidden) boxes.push({ ...one, rect, above: one.element.closest(".strip") !== null });
    }
  }
  boxes.sort((a, b) => a.rect.top - b.rect.top);
  boxes.forEach((a, i) => {
    for (let k = i + 1; k < boxes.length && boxes[k].rect.top < a.rect.bottom - 3; ++k) {
      const b = boxes[k];
      if (a.element === b.element || a.above !== b.above) continue;
      const across = Math.min(a.rect.right, b.rect.right) - Math.max(a.rect.left, b.rect.left);
      const down = Math.min(a.rect.bottom, b.rect.bottom) - Math.max(a.rect.top, b.rect.top);
      const drawn = a.element.closest("svg") || b.element.closest("svg");
      if (across > 2 && down > (drawn ? 6 : 4)) found.push(`"${a.text.slice(0, 40)}" over "${b.text.slice(0, 40)}" in ${nameOf(a.element)}`);
    }
  });
  return found;
}

function unreadable() {
  const texts = shownTexts(), width = document.documentElement.clientWidth, found = overlaps(texts);
  if (document.documentElement.scrollWidth > width + 1) {
    found.push(`the page is ${document.documentElement.scrollWidth - width} px too wide`);
  }
  for (const { text, element, rects, scroller, broken } of texts) {
    const say = (what) => found.push(`${what}: "${text.slice(0, 60)}" in ${nameOf(element)}`);
    broken.forEach((word) => say(`"${word}" is broken`));
    if (scroller) continue; // what is beyond its edge is reached by scrolling
    if (rects.some((rect) => rect.left < -1 || rect.right > width + 1)) say("beyond the page");
    const clipping = about(element, (style) => /hidden|clip/.test(style.overflowX + style.overflowY));
    const box = clipping && clipping.getBoundingClientRect();
    if (box && rects.some((rect) => rect.left < box.left - 2 || rect.right > box.right + 2 || rect.top < box.top - 3 ||
      rect.bottom > box.bottom + 3)) say("cut");
  }
  return [...new Set(found)];
}

/** Texts of the page as it is now that cannot be read. */
export async function textFaults(page) {
  return page.evaluate(`(() => { ${[nameOf, about, shownTexts, overlaps, unreadable].join("\n")} return unreadable(); })()`);
}

/** What axe-core finds wrong. */
export async function axeFaults(page, axe, rules) {
  if (!await page.evaluate(() => Boolean(window.axe))) await page.addScriptTag({ path: axe });
  const result = await page.evaluate((only) => window.axe.run(document, { resultTypes: ["violations"],
    ...(only ? { runOnly: { type: "rule", values: only } } : {}) }), rules);
  return result.violations.flatMap((violation) => violation.nodes.slice(0, 8).map((node) =>
    `${violation.id}: ${node.target.join(" ")}: ${(node.any[0] || node.all[0] || node.none[0] || {}).message || violation.help}`));
}

/** What can be used by pointer but is not reached by Tab. */
export async function unreached(page) {
  const count = await page.evaluate(() => {
    const usable = [...document.querySelectorAll("a[href], button, input, select, textarea, summary, [tabindex='0']")]
      .filter((element) => !element.disabled && element.checkVisibility({ checkVisibilityCSS: true }) &&
        !(element.closest("details:not([open])") && element.tagName !== "SUMMARY"));
    usable.forEach((element, k) => { element.dataset.usable = String(k); });
    document.activeElement.blur();
    window.reached = new Set();
    document.addEventListener("focusin", (event) => window.reached.add(event.target.dataset.usable));
    return usable.length;
  });
  for (let k = 0; k < count + 5; ++k) await page.keyboard.press("Tab");
  return page.evaluate(() => [...document.querySelectorAll("[data-usable]")]
    .filter((element) => !window.reached.has(element.dataset.usable))
    // Of radio buttons of one name Tab reaches the one that is chosen; arrows reach the others.
    .filter((element) => !(element.type === "radio" && document.querySelector(`input[name="${element.name}"]:checked`) !== element))
    .map((element) => `not reached: ${element.outerHTML.slice(0, 100)}`));
}

/** Waits until charts have the size of the page. */
export async function settledLayout(page) {
  await lookAtAll(page);
  await page.evaluate(() => new Promise((resolve) => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(resolve)), 150)));
}

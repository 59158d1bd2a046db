// Puts a report together as the program describes it (include/tribofit/report/report.hpp).

const textItems = {
  plain: (text) => make("p", {}, prose(text)),
  soft: (text) => make("p", { className: "soft" }, prose(text)),
  warning: (text) => make("p", { className: "warning" }, prose(text)),
  command: (text) => make("pre", {}, text),
  heading: (text) => make("h3", {}, text),
  item: (text) => make("p", { className: "item" }, prose(text)),
};

const itemMakers = {
  text: (item) => textItems[item.kind](item.text),
  table: (item) => {
    const whole = table(item.folded ? "" : item.caption, item.header, item.rows, item.numeric || []);
    if (!item.folded) return whole;
    return make("details", {}, make("summary", {}, item.caption), whole);
  },
  chart: chartFigure,
  animation: animationFigure,
};

/** Fills a section; charts that it has already are changed, not made anew. */
function fillSection(element, section) {
  const parts = [make("h2", {}, section.title)];
  let pair = null;
  for (const item of section.items) {
    const made = itemMakers[item.type](item);
    if (!item.half) {
      pair = null;
      parts.push(made);
      continue;
    }
    if (!pair) {
      pair = make("div", { className: "pair" });
      parts.push(pair);
    }
    pair.append(made);
  }
  element.replaceChildren(...parts);
}

function headerItems(report) {
  const links = report.sections.map((section) => make("li", {}, make("a", { href: `#${section.id}` }, section.title)));
  return [make("h1", {}, report.title), make("p", { className: "soft" }, report.subtitle),
    report.lead ? make("p", { className: "verdict" }, prose(report.lead)) : null,
    ...report.warnings.map((warning) => make("p", { className: "warning" }, make("strong", {}, "Warning: "), prose(warning))),
    make("nav", { "aria-label": "Sections" }, make("ul", {}, ...links)), facts(report.facts)].filter((part) => part !== null);
}

let lastShown = null;
darkScreen.addEventListener("change", () => lastShown && showReport(lastShown.main, lastShown.report));

/** Shows a report; what stands there already is brought up to date. */
function showReport(main, report) {
  givenStyles = report.styles;
  setTheme(darkScreen.matches);
  lastShown = { main, report };
  document.title = `${report.title} – ${report.kind}`;
  const before = new Map([...main.querySelectorAll(":scope > section")].map((element) => [element.id, element]));
  const sections = report.sections.map((section) => {
    const element = before.get(section.id) || make("section", { id: section.id });
    fillSection(element, section);
    return element;
  });
  main.replaceChildren(...headerItems(report), ...sections);
}

// Puts a report together as the program describes it (include/tribofit/report/report.hpp).

const itemMakers = {
  text: ({ kind, text }) => (kind === "command" ? make("pre", {}, text) : kind === "heading" ? make("h3", {}, text)
    : make("p", { className: kind }, prose(text))),
  table: (item) => {
    const whole = table(item.folded ? "" : item.caption, item.columns.map((column) => column.name), item.rows,
      item.columns.flatMap((column, k) => (column.number ? [k] : [])));
    if (!item.folded) return whole;
    return make("details", {}, make("summary", {}, item.caption), whole);
  },
  facts: (item) => make("div", {}, ...item.facts.map(([name, value]) => itemMakers.text({ kind: "item", text: `${name}: ${value}` }))),
  animation: animationFigure,
};

/** Puts children into an element. Those that stand there already stay attached: whatever is taken out and put back, a
 * chart above all, is styled, laid out and painted anew. */
function arrange(element, children) {
  const wanted = new Set(children);
  for (const child of [...element.childNodes]) if (!wanted.has(child)) child.remove();
  let next = element.firstChild;
  for (const child of children) {
    if (child === next) next = next.nextSibling;
    else element.insertBefore(child, next);
  }
}

const madeItems = new WeakMap(); // by section: what was made of each description

/** Makes the items of a section, or takes those that it has where they are described alike. */
function makeItems(element, items) {
  const before = madeItems.get(element) || new Map(), now = new Map();
  const made = items.map((item, k) => {
    if (item.type === "chart") return chartFigure(item); // which knows its own
    const described = `${k} ${JSON.stringify(item)}`;
    now.set(described, before.get(described) || itemMakers[item.type](item));
    return now.get(described);
  });
  madeItems.set(element, now);
  return made;
}

/** Fills a section; what it has already stays, and charts are changed, not made anew. Halves stand beside each other. */
function fillSection(element, section) {
  const title = element.querySelector(":scope > h2") || make("h2");
  if (title.textContent !== section.title) title.textContent = section.title;
  const made = makeItems(element, section.items);
  made.forEach((one, k) => one.classList.toggle("half", section.items[k].half === true));
  element.className = "parts";
  arrange(element, [title, ...made]);
}

function headerItems(report) {
  const links = report.sections.map((section) => make("li", {}, make("a", { href: `#${section.id}` }, section.title)));
  return [make("h1", {}, report.title), make("p", { className: "soft" }, report.subtitle),
    report.lead ? make("p", { className: "verdict" }, prose(report.lead)) : null,
    ...report.warnings.map((warning) => make("p", { className: "warning" }, make("strong", {}, "Warning: "), prose(warning))),
    make("nav", { "aria-label": "Sections" }, make("ul", {}, ...links)), facts(report.facts)].filter((part) => part !== null);
}

/** Shows a report; what stands there already is brought up to date. */
function showReport(main, report) {
  Object.assign(styles, report.styles);
  document.title = `${report.title} – ${report.kind}`;
  const before = new Map([...main.querySelectorAll(":scope > section")].map((element) => [element.id, element]));
  const sections = report.sections.map((section) => {
    const element = before.get(section.id) || make("section", { id: section.id });
    fillSection(element, section);
    return element;
  });
  arrange(main, [...headerItems(report), ...sections]);
}

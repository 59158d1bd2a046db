// Elements and tables. Text of the data always goes in as text, never as markup.

/** An element with properties and children (strings become text). */
function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name === "className" || name.startsWith("on") || name === "textContent") element[name] = value;
    else if (value !== null && value !== undefined) element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

function svgPart(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** A number with up to `digits` significant digits, as a person writes it; "-" where it is not known. */
function number(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-6) return value.toExponential(digits - 1).replace("-", "−");
  const places = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return value.toFixed(Math.min(places, 12)).replace("-", "−");
}

/** Symbols that the program spells in letters, as options and tables need them: mu_s, omega r, +/-. */
function symbols(text) {
  return text.replace(/\+\/-/g, "±").replace(/\bmu(?=_[a-z0-9]\b|\b(?!_))/g, "μ").replace(/\bomega r\b/g, "ω r");
}

/** Text of the program as a page has it. */
function prose(text) {
  const words = symbols(text);
  return words.replace(/^[a-z](?=[a-z'-]*( [^=]|$))/, (letter) => letter.toUpperCase()); // but "mu_s" and "mu = ..."
}

/** A table; columns named in `numeric` are set to the right. Where it is wider than its place it scrolls. */
function table(caption, header, rows, numeric = []) {
  const isLong = (k) => rows.some((row) => String(row[k] ?? "").length > 16);
  const aligned = header.map((_, k) => (numeric.includes(k) ? { className: "number" } : isLong(k) ? { className: "words" } : {}));
  const cell = (tag, content, k, more = {}) => make(tag, { ...aligned[k], ...more }, symbols(String(content)));
  const whole = make("table", {}, caption ? make("caption", {}, symbols(caption)) : null,
    make("thead", {}, make("tr", {},
      ...header.map((name, k) => (name ? cell("th", name, k, { scope: "col" }) : make("td"))))),
    make("tbody", {}, ...rows.map((row) => make("tr", {}, ...header.map((_, k) => cell("td", row[k] ?? "", k))))));
  if (header.length > 8) whole.className = "wide";
  return make("div", { className: "scroll", tabindex: "0", role: "group", "aria-label": symbols(caption || "Table") }, whole);
}

/** Facts as a list of names and values. */
function facts(pairs) {
  return make("dl", { className: "facts" }, ...pairs.filter(([, value]) => value)
    .map(([name, value]) => make("div", {}, make("dt", {}, prose(name)), make("dd", {}, prose(value)))));
}

/** Saves content, or what a link leads to. */
function save(name, content) {
  make("a", { href: content instanceof Blob ? URL.createObjectURL(content) : content, download: name }).click();
}

/** The numbers of a chart behind a switch: made when it is opened, and anew by its fill(); cut after `most` rows, whole as
 * CSV. */
function numbersOf(name, headerOf, rowsOf) {
  const most = 500;
  const details = make("details", { className: "numbers" }, make("summary", {}, "Numbers of this chart"));
  details.fill = () => {
    while (details.childElementCount > 1) details.lastChild.remove();
    if (!details.open) return;
    const header = headerOf(), rows = rowsOf();
    const text = (value) => (typeof value === "number" ? String(Number(value.toPrecision(9))) : value ?? "");
    const quoted = (value) => (/[",\n]/.test(text(value)) ? `"${text(value).replace(/"/g, '""')}"` : text(value));
    const csv = () => [header, ...rows].map((row) => row.map(quoted).join(",")).join("\n") + "\n";
    const numeric = header.map((_, k) => k).filter((k) => rows.some((row) => typeof row[k] === "number"));
    details.append(
      make("button", { type: "button", onclick: () => save(`${name}.csv`, new Blob([csv()], { type: "text/csv" })) },
        `Save all ${rows.length} rows as CSV`),
      table("", header, rows.slice(0, most).map((row) => row.map(text)), numeric));
    if (rows.length > most) details.append(make("p", { className: "soft" }, `The first ${most} rows are shown.`));
  };
  details.addEventListener("toggle", details.fill);
  return details;
}

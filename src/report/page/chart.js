// A chart with its title, legend, tools and numbers. Colours are those of Okabe and Ito, told apart by people who do
// not see colours alike; lines differ in their dashes and points in their shape as well.

const ink = { black: "#000000", blue: "#0072b2", red: "#d55e00", green: "#009e73", purple: "#a0508a", grey: "#6b6b6b" };
const pale = { blue: "rgba(0,114,178,0.22)", red: "rgba(213,94,0,0.22)", black: "rgba(0,0,0,0.14)",
  green: "rgba(0,158,115,0.2)", purple: "rgba(160,80,138,0.2)", grey: "rgba(107,107,107,0.2)" };
const slipFill = "rgba(230,159,0,0.16)", stickFill = "rgba(0,0,0,0.07)", beyondFill = "rgba(0,0,0,0.09)";

/** Text that a chart takes as text: no tags, no entities. */
function plain(text) {
  return String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
}

/** A line; `more` goes to the library as it is. name doubles as the group that the legend switches. */
function line(name, series, style = {}, more = {}) {
  const { colour = "black", dash = "solid", width = 1.6, symbol = null } = style;
  return { type: "scatter", mode: symbol ? "lines+markers" : "lines", name: plain(name), legendgroup: name,
    x: series.x, y: series.y, line: { color: ink[colour], dash, width },
    marker: { symbol: symbol || "circle", size: 5, color: ink[colour] }, ...more };
}

function points(name, series, style = {}, more = {}) {
  const { colour = "black", symbol = "circle", size = 6 } = style;
  return { type: "scatter", mode: "markers", name: plain(name), legendgroup: name, x: series.x, y: series.y,
    marker: { symbol, size, color: ink[colour] }, ...more };
}

/** A band between two curves over the same abscissa, switched together with the line of that name. */
function band(name, x, low, high, colour, more = {}) {
  const edge = { type: "scatter", mode: "lines", legendgroup: name, showlegend: false, hoverinfo: "skip", x,
    line: { width: 0, color: ink[colour] }, ...more };
  return [{ ...edge, name: `${plain(name)}, lower edge`, y: low },
    { ...edge, name: `${plain(name)}, upper edge`, y: high, fill: "tonexty", fillcolor: pale[colour] }];
}

function axis(title, more = {}) {
  return { title: { text: title, standoff: 8 }, automargin: true, zeroline: false, showline: true, linecolor: "#444",
    gridcolor: "#e2e2e2", ticks: "outside", tickcolor: "#444", exponentformat: "power", ...more };
}

const basicLayout = {
  font: { family: 'system-ui, "Segoe UI", Roboto, "Liberation Sans", sans-serif', size: 13, color: "#1b1b1b" },
  margin: { l: 62, r: 14, t: 10, b: 46 }, paper_bgcolor: "#fff", plot_bgcolor: "#fff", hovermode: "closest",
  showlegend: false, hoverlabel: { bgcolor: "#fff", bordercolor: "#444", font: { color: "#1b1b1b" } },
};

/** What a line looks like, for the legend. */
function swatch(trace) {
  const space = "http://www.w3.org/2000/svg";
  const draw = (tag, attributes) => {
    const element = document.createElementNS(space, tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    return element;
  };
  const svg = draw("svg", { width: 34, height: 12, "aria-hidden": "true" });
  if (trace.type === "bar") {
    svg.append(draw("rect", { x: 6, y: 1, width: 22, height: 10, fill: trace.marker.color, stroke: "#000" }));
    if (trace.marker.pattern && trace.marker.pattern.shape) {
      svg.append(draw("path", { d: "M8,11l8,-10M14,11l8,-10M20,11l8,-10", stroke: "#fff", "stroke-width": 1.5 }));
    }
    return svg;
  }
  const dashes = { solid: "", dash: "7 4", dot: "2 3", dashdot: "7 3 2 3", longdash: "12 4" };
  const mode = trace.mode || "lines", colour = trace.line ? trace.line.color : trace.marker.color;
  if (mode.includes("lines")) {
    svg.append(draw("line", { x1: 0, x2: 34, y1: 6, y2: 6, stroke: colour, "stroke-width": trace.line.width + 0.6,
      "stroke-dasharray": dashes[trace.line.dash] || "" }));
  }
  if (mode.includes("markers")) {
    const shapes = { circle: "M17,2a4,4 0 1,0 0.01,0z", "triangle-up": "M17,1L22,10L12,10z",
      "triangle-down": "M17,11L22,2L12,2z", square: "M13,2h8v8h-8z", diamond: "M17,1l5,5l-5,5l-5,-5z",
      x: "M13,2l8,8m0,-8l-8,8" };
    svg.append(draw("path", { d: shapes[trace.marker.symbol] || shapes.circle, fill: colour, stroke: colour }));
  }
  return svg;
}

const waiting = []; // charts not drawn yet
const drawn = [];

/**
 * Puts a chart into `parent`; it is drawn when its turn comes. spec: {id, title, note, traces, layout, height, header,
 * rows}; rows() gives the table of numbers where the lines themselves do not.
 */
function chart(parent, spec) {
  const plot = make("div", { className: "plot", id: spec.id, tabindex: "0", role: "img",
    "aria-label": `Chart: ${spec.title}. Keys: plus and minus zoom, arrows move, 0 shows all. ` +
      "Its numbers stand in the table below it." });
  plot.style.height = `${spec.height || 340}px`;
  const legend = make("div", { className: "legend" });
  const tools = make("div", { className: "tools" });
  const figure = make("figure", {}, make("figcaption", {}, make("h3", {}, spec.title),
    spec.note ? make("p", {}, spec.note) : null), plot, legend, tools,
  numbersOf(spec.id, spec.header, spec.rows || (() => rowsOf(spec.traces))));
  parent.append(figure);
  const item = { ...spec, plot, figure, layout: { ...basicLayout, height: spec.height || 340, ...spec.layout } };
  // The library writes the present range into the layout it is given.
  item.ranges = Object.fromEntries(Object.entries(spec.layout).filter(([, part]) => part && part.range)
    .map(([name, part]) => [name, [...part.range]]));
  if (matchMedia("(pointer: coarse)").matches) item.layout.dragmode = false; // a finger scrolls the page
  addLegend(legend, item);
  addTools(tools, item);
  plot.addEventListener("keydown", (event) => onKey(event, item));
  waiting.push(item);
  return item;
}

function rowsOf(traces) {
  const rows = [];
  for (const trace of traces) {
    for (let k = 0; k < trace.x.length; ++k) {
      if (trace.y[k] !== null && trace.y[k] !== undefined) rows.push([trace.name, trace.x[k], trace.y[k]]);
    }
  }
  return rows;
}

function draw(item) {
  if (item.done) return;
  item.done = true;
  Plotly.newPlot(item.plot, item.traces, item.layout, { responsive: true, displaylogo: false, displayModeBar: false,
    doubleClick: "reset", scrollZoom: false });
  drawn.push(item);
}

/** Draws what waits, one chart after the other so that the page stays alive. */
function drawWaiting() {
  const item = waiting.shift();
  if (!item) {
    document.documentElement.dataset.drawn = "all";
    return;
  }
  draw(item);
  setTimeout(drawWaiting, 0);
}

/** One button for each name: a line and its band go together. */
function addLegend(legend, item) {
  const named = item.traces.filter((trace) => trace.showlegend !== false && trace.legendgroup);
  if (named.length < 2 && !item.keys) return;
  const seen = new Set();
  for (const trace of named) {
    if (seen.has(trace.legendgroup)) continue;
    seen.add(trace.legendgroup);
    const on = trace.visible !== "legendonly";
    legend.append(make("button", { type: "button", "aria-pressed": String(on), title: "Show or hide",
      onclick: (event) => toggle(item, trace.legendgroup, event.currentTarget) }, swatch(trace), trace.legendgroup));
  }
  for (const [name, fill] of item.keys || []) {
    const key = make("span", { className: "key" });
    key.style.background = fill;
    legend.append(make("span", { className: "soft" }, key, name));
  }
}

function toggle(item, group, button) {
  draw(item);
  const on = button.getAttribute("aria-pressed") !== "true";
  button.setAttribute("aria-pressed", String(on));
  const indices = item.traces.map((trace, k) => (trace.legendgroup === group ? k : -1)).filter((k) => k >= 0);
  Plotly.restyle(item.plot, { visible: on ? true : "legendonly" }, indices);
}

const axesOf = (item, letter) => Object.keys(item.plot._fullLayout)
  .filter((name) => new RegExp(`^${letter}axis[0-9]*$`).test(name));

/** Zooms about the middle (factor below 1: closer) and moves by a part of the width. */
function zoom(item, factor, move = 0, letters = "x") {
  draw(item);
  const change = {};
  for (const letter of letters) {
    for (const name of axesOf(item, letter)) {
      const full = item.plot._fullLayout[name];
      if (full.type === "category" || full.fixedrange) continue;
      const [low, high] = full.range;
      const middle = (low + high) / 2 + move * (high - low), half = (factor * (high - low)) / 2;
      change[`${name}.range`] = [middle - half, middle + half];
    }
  }
  Plotly.relayout(item.plot, change);
}

function showAll(item) {
  draw(item);
  const change = {};
  for (const letter of "xy") {
    for (const name of axesOf(item, letter)) {
      if (item.ranges[name]) change[`${name}.range`] = [...item.ranges[name]];
      else change[`${name}.autorange`] = true;
    }
  }
  Plotly.relayout(item.plot, change);
}

function onKey(event, item) {
  const actions = { "+": () => zoom(item, 0.5), "=": () => zoom(item, 0.5), "-": () => zoom(item, 2),
    ArrowLeft: () => zoom(item, 1, -0.2), ArrowRight: () => zoom(item, 1, 0.2), 0: () => showAll(item) };
  const action = event.ctrlKey || event.altKey || event.metaKey ? null : actions[event.key];
  if (!action) return;
  event.preventDefault();
  action();
}

/** Saves the chart with title and legend, wide enough for print. */
function savePicture(item, format) {
  draw(item);
  const layout = { ...item.plot.layout, showlegend: true, width: 900, height: 560,
    title: { text: plain(item.title), x: 0.5 }, margin: { l: 70, r: 20, t: 60, b: 110 },
    legend: { orientation: "h", y: -0.18, yanchor: "top" } };
  return Plotly.toImage({ data: item.plot.data, layout }, { format, width: 900, height: 560, scale: format === "png" ? 3 : 1 })
    .then((url) => make("a", { href: url, download: `${item.id}.${format}` }).click());
}

function addTools(tools, item) {
  const button = (text, title, action) =>
    make("button", { type: "button", title, "aria-label": `${title}: ${item.title}`, onclick: action }, text);
  tools.append(button("+", "Zoom in", () => zoom(item, 0.5)), button("\u2212", "Zoom out", () => zoom(item, 2)),
    button("All", "Show all", () => showAll(item)), button("SVG", "Save as SVG", () => savePicture(item, "svg")),
    button("PNG", "Save as PNG", () => savePicture(item, "png")));
}

// On paper charts are as wide as the page.
addEventListener("beforeprint", () => {
  while (waiting.length > 0) draw(waiting.shift());
  for (const item of drawn) {
    Plotly.relayout(item.plot, { width: 640, autosize: false });
  }
});
addEventListener("afterprint", () => {
  for (const item of drawn) Plotly.relayout(item.plot, { width: null, autosize: true });
});

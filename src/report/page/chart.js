// Draws a chart as the program describes it (include/tribofit/report/chart.hpp), with its title, legend, tools and
// numbers. It is drawn for white paper; a dark screen shows it inverted (page.css).

const styles = {}; // what charts are drawn with (styles.hpp)

/** Text that a chart takes as text: no tags, no entities. */
function plain(text) {
  return symbols(String(text)).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
}

/** Text with the subscripts and superscripts of "v_{r}" and "s^{2}". */
function marked(text) {
  return plain(text).replace(/_\{([^}]*)\}/g, "<sub>$1</sub>").replace(/\^\{([^}]*)\}/g, "<sup>$1</sup>")
    .replace(/\n/g, "<br>");
}

const unmarked = (text) => String(text).replace(/([_^])\{([^}]*)\}/g, "$1$2");
const titleOf = (axis) => (axis.unit ? `${axis.quantity} [${axis.unit}]` : axis.quantity);

const letterWidth = 7.5;

/** A title on as many lines as so many pixels ask for. */
function brokenTitle(text, room = innerWidth - 90) {
  const most = Math.max(10, Math.floor(room / letterWidth));
  const blank = text.length > most ? text.lastIndexOf(" ", most) : -1;
  return blank > 0 ? `${text.slice(0, blank)}\n${brokenTitle(text.slice(blank + 1), room)}` : text;
}
const along = (axis, value) => (axis.logarithmic ? Math.log10(value) : value);
const unitOf = (axis) => (axis.unit && axis.unit !== "1" ? ` ${axis.unit}` : "");

function axisOf(axis, more = {}) {
  const layout = { title: { text: marked(brokenTitle(titleOf(axis))), standoff: 8 }, automargin: true,
    zeroline: false, showline: true,
    linecolor: styles.axis, gridcolor: styles.grid, ticks: "outside", tickcolor: styles.axis, exponentformat: "power",
    hoverformat: ".7~g", ticklabeloverflow: "allow", ...more }; // the margins have room for every label
  if (axis.names.length) {
    // More names than can be read take minutes to lay out; each still shows beside its point.
    const every = Math.ceil(axis.names.length / 40), shown = axis.names.map((_, k) => k).filter((k) => k % every === 0);
    Object.assign(layout, { tickvals: shown, ticktext: shown.map((k) => plain(axis.names[k])), showgrid: false,
      range: [-0.6, axis.names.length - 0.4] });
  }
  if (axis.logarithmic) layout.type = "log";
  if (axis.from_zero) layout.rangemode = "tozero";
  if (axis.low !== null && axis.high !== null) layout.range = [axis.low, axis.high].map((end) => along(axis, end));
  return layout;
}

const nth = (letter, panel) => (panel ? `${letter}${panel + 1}` : letter);

/** Hover text: both values with their units, and the line. */
function hoverOf(chart, panel, bars) {
  const valueOf = (axis, value) => (axis.names.length ? "%{customdata}"
    : `${marked(axis.quantity)} ${value}${plain(unitOf(axis))}`);
  const x = valueOf(chart.x, "%{x}"), y = valueOf(chart.panels[panel], "%{y:.5g}");
  return { hovertemplate: `${x}<br>${y}${bars ? "<br>%{text}" : ""}<extra>%{fullData.name}</extra>` };
}

/** A band under its line, switched together with it: one filled shape, which goes along the upper edge and back along the
 * lower one between gaps. */
function bandOf(line, shape) {
  const x = [], y = [];
  for (let begin = 0, end = 0; end <= line.x.length; ++end) {
    if (end < line.x.length && line.low[end] !== null && line.high[end] !== null) continue;
    if (end > begin) {
      const stretch = line.x.slice(begin, end);
      x.push(...stretch, ...stretch.reverse(), null);
      y.push(...line.high.slice(begin, end), ...line.low.slice(begin, end).reverse(), null);
    }
    begin = end + 1;
  }
  return { ...shape, name: `${plain(line.name)}, band`, x, y, fill: "toself", fillcolor: styles.pale[line.stroke.colour] };
}

/** Names beside the points of a line, and its values that count them. */
const namesOf = (chart, line) => (chart.x.names.length ? { names: chart.x.names, along: line.x }
  : { names: chart.panels[line.panel].names, along: line.y });

function tracesOfLine(chart, line, listed) {
  const { dash, symbol, width, size, joined } = line.stroke, color = styles.colours[line.stroke.colour];
  const common = { type: "scatter", legendgroup: line.name, x: line.x, yaxis: nth("y", line.panel),
    visible: line.shown ? true : "legendonly" };
  const traces = [];
  if (line.low.length && !line.bars) {
    traces.push(bandOf(line, { ...common, mode: "lines", showlegend: listed && !line.y.length, hoverinfo: "skip",
      line: { width: 0, color } }));
  }
  if (!line.y.length) return traces;
  const marks = symbol !== "none";
  const trace = { ...common, mode: marks ? (joined ? "lines+markers" : "markers") : "lines", name: plain(line.name),
    y: line.y, line: { color, dash: styles.dashes[dash], width }, showlegend: listed,
    marker: { symbol: marks ? symbol : "circle", size, color,
      ...(joined && !line.bars ? { maxdisplayed: styles.most_symbols } : {}) },
    ...hoverOf(chart, line.panel, line.bars) };
  const { names, along } = namesOf(chart, line);
  if (names.length) trace.customdata = along.map((at) => plain(names[Math.round(at)] || ""));
  if (line.bars) {
    trace.error_y = { type: "data", symmetric: false, array: line.y.map((y, k) => line.high[k] - y),
      arrayminus: line.y.map((y, k) => y - line.low[k]), thickness: 1.3, width: 4, color };
    trace.text = line.y.map((_, k) => `from ${number(line.low[k], 5)} to ${number(line.high[k], 5)}`);
  }
  return [...traces, trace];
}

function tracesOfMap(chart) {
  const map = chart.map, x = chart.x, y = chart.panels[0];
  const colours = map.diverging ? styles.diverging : styles.heat;
  const cells = { type: "heatmap", name: plain(map.quantity), x: map.x, y: map.y, z: map.z,
    zmin: map.low ?? undefined, zmax: map.high ?? undefined,
    zauto: map.low === null, colorscale: colours.map((colour, k) => [k / (colours.length - 1), colour]), hoverongaps: false,
    opacity: map.diverging ? 1 : 0.6, // lines and their numbers must be read on it
    colorbar: { title: { text: marked(titleOf(map)), side: "right" }, thickness: 12, outlinecolor: styles.axis,
      tickcolor: styles.axis, tickfont: { color: styles.text } },
    hovertemplate: `${marked(x.quantity)} %{x}${plain(unitOf(x))}<br>${marked(y.quantity)} %{y}${plain(unitOf(y))}` +
      `<br>%{z:.5g}${plain(unitOf(map))}<extra></extra>` };
  if (map.diverging) return [cells];
  return [cells, { type: "contour", x: map.x, y: map.y, z: map.z, ncontours: 8, showscale: false, hoverinfo: "skip",
    showlegend: false, connectgaps: false, line: { color: styles.colours.black, width: 1 },
    contours: { coloring: "none", showlabels: true, labelfont: { size: 11, color: styles.colours.black } } }];
}

function tracesOf(chart) {
  const traces = chart.map ? tracesOfMap(chart) : [], names = new Set(); // the legend names each once
  for (const line of chart.lines) {
    traces.push(...tracesOfLine(chart, line, !names.has(line.name)));
    names.add(line.name);
  }
  return traces;
}

function shapesOf(chart) {
  const upright = (from, to) => ({ xref: "x", yref: "paper", x0: from, x1: to, y0: 0, y1: 1 });
  const level = (at, panel) => ({ xref: "paper", x0: 0, x1: 1, yref: nth("y", panel), y0: at, y1: at });
  return [
    ...chart.stretches.map((s) => ({ type: "rect", layer: "below", ...upright(s.from, s.to), line: { width: 0 },
      fillcolor: styles.shades[s.shade].fill })),
    ...chart.marks.map((mark) => ({ type: "line", line: { color: styles.axis, width: 1.3, dash: styles.dashes[mark.dash] },
      ...(mark.upright ? upright(mark.at, mark.at) : level(mark.at, mark.panel)) }))];
}

function annotationsOf(chart) {
  const named = chart.marks.filter((mark) => mark.text);
  const all = chart.lines.flatMap((line) => line.x).filter(Number.isFinite).map((x) => along(chart.x, x));
  const low = Math.min(...all), high = Math.max(...all);
  // Of words at upright marks, one below the other; on a narrow screen below those at a level mark of the panel.
  let rows = innerWidth < 500 && named.some((mark) => !mark.upright && !mark.panel) ? 1.4 : 0;
  return named.map((mark) => {
    const word = { showarrow: false, font: { size: 11 }, bgcolor: styles.halo, textangle: 0, xanchor: "left",
      align: "left" };
    if (!mark.upright) {
      return { ...word, text: marked(mark.text), xref: "paper", x: 0, yref: nth("y", mark.panel),
        y: along(chart.panels[mark.panel], mark.at), yanchor: mark.at < 0 ? "top" : "bottom" };
    }
    const text = innerWidth < 500 ? mark.text.replace(/, (?![^[]*\])| (?=\[)/g, "\n") : mark.text;
    const x = along(chart.x, mark.at), yshift = -15 * rows;
    rows += text.split("\n").length;
    return { ...word, text: marked(text), xref: "x", x, yref: "paper", y: 1, yanchor: "top", yshift,
      ...(x - low > 0.6 * (high - low) ? { xanchor: "right", align: "right" } : {}) };
  });
}

/** Panels one above the other, with room between them. */
function layoutOf(chart) {
  const gap = 0.06, count = chart.panels.length;
  const whole = chart.panels.reduce((sum, panel) => sum + panel.part, 0), free = 1 - gap * (count - 1);
  // Room for labels. The library draws a chart twice whose labels need more; but narrow screens have no more, and a page
  // that changes under the hand is up to date sooner with less.
  const margin = innerWidth < 500 || changesUnderHand ? { l: 62, r: 14, t: 10, b: 46 } : { l: 88, r: 14, t: 20, b: 56 };
  const layout = { margin, font: { family: 'system-ui, "Segoe UI", Roboto, "Liberation Sans", sans-serif', size: 13,
    color: styles.text },
    paper_bgcolor: styles.paper, plot_bgcolor: styles.paper, hovermode: "closest",
    showlegend: false, hoverlabel: { bgcolor: styles.paper, bordercolor: styles.axis, font: { color: styles.text } },
    height: chart.height, uirevision: chart.id, shapes: shapesOf(chart), annotations: annotationsOf(chart),
    xaxis: axisOf(chart.x, { anchor: nth("y", count - 1) }) };
  let top = 1;
  chart.panels.forEach((panel, k) => {
    const height = (free * panel.part) / whole;
    layout[nth("yaxis", k)] = axisOf(panel, { domain: [Math.max(0, top - height), top] });
    top -= height + gap;
  });
  if (matchMedia("(pointer: coarse)").matches) layout.dragmode = false; // a finger scrolls the page
  return layout;
}

/** Title and names below a chart, as its width has room for them: names that do not fit stand upright. */
function fitBelow(layout, chart, width) {
  const longest = (axis) => letterWidth * Math.max(0, ...axis.names.map((name) => plain(name).length));
  const room = width - layout.margin.l - layout.margin.r - Math.max(...chart.panels.map(longest));
  layout.xaxis.title.text = marked(brokenTitle(titleOf(chart.x), room));
  if (chart.x.names.length && longest(chart.x) + 12 > room / layout.xaxis.ticktext.length) layout.xaxis.tickangle = -90;
}

/** The numbers of a chart: a row a point. */
function rowsOf(chart) {
  const title = (axis) => unmarked(titleOf(axis)), y = chart.panels[0], none = [null, null];
  const rows = chart.lines.flatMap((line) => line.x.map((at, k) => {
    const { names, along } = namesOf(chart, line), name = names[Math.round(along[k])];
    if (y.names.length) return [line.name, name, title(chart.x), at, ...none];
    const values = [line.y, line.low, line.high].map((all) => all[k] ?? null);
    return [line.name, name ?? at, title(chart.panels[line.panel]), ...values];
  }));
  if (chart.map) {
    chart.map.z.forEach((row, i) => rows.push(...row.map((z, k) =>
      [`${title(y)} = ${chart.map.y[i]}`, chart.map.x[k], title(chart.map), z, ...none])));
  }
  rows.push(...chart.stretches.map(({ shade, from, to }) => [styles.shades[shade].meaning, from, "end", to, ...none]));
  return rows.filter((row) => row[3] !== null || row[4] !== null);
}

const headerOf = (chart) => ["line", unmarked(chart.panels[0].names.length ? "name" : titleOf(chart.x)), "quantity",
  "value", "low", "high"];

/** What a line looks like, for the legend. */
function swatch(trace) {
  const svg = svgPart("svg", { width: 34, height: 12, "aria-hidden": "true" });
  if (trace.fill) {
    svg.append(svgPart("rect", { x: 6, y: 1, width: 22, height: 10, fill: trace.fillcolor }));
    return svg;
  }
  const colour = trace.line.color;
  if (trace.mode.includes("lines")) {
    svg.append(svgPart("line", { x1: 0, x2: 34, y1: 6, y2: 6, stroke: colour, "stroke-width": trace.line.width + 0.6,
      "stroke-dasharray": trace.line.dash === "solid" ? "" : trace.line.dash.replace(/px/g, "") }));
  }
  if (trace.mode.includes("markers")) {
    svg.append(svgPart("path", { d: styles.symbols[trace.marker.symbol], fill: colour, stroke: colour,
      transform: "translate(17 6) scale(4)", "vector-effect": "non-scaling-stroke" }));
  }
  return svg;
}

const chartItems = new Map(); // by id

/** The figure of a chart; one of the same id is changed, and keeps its zoom and what its legend switched. */
function chartFigure(chart) {
  const item = chartItems.get(chart.id) || makeChart(chart), described = JSON.stringify(chart);
  if (item.described === described && (item.shown === described || waiting.includes(item))) return item.figure;
  item.described = described;
  item.chart = chart;
  prepare(item);
  item.title.textContent = symbols(chart.title);
  item.note.textContent = prose(chart.note);
  item.plot.style.height = `${chart.height}px`;
  item.numbers.fill();
  drawSoon(item);
  return item.figure;
}

/** What the library draws of a chart, with what was switched and how it is dragged. */
function prepare(item, layout = {}) {
  item.traces = tracesOf(item.chart);
  item.layout = { ...layoutOf(item.chart), ...item.drag, ...layout };
  for (const trace of item.traces) {
    if (item.switched.has(trace.legendgroup)) trace.visible = item.switched.get(trace.legendgroup);
  }
  fillLegend(item);
}

function makeChart(chart) {
  const plot = make("div", { className: "plot", id: chart.id, tabindex: "0", role: "img",
    "aria-label": `Chart: ${chart.title}. Keys: plus and minus zoom, arrows move, 0 shows all. ` +
      "Its numbers stand in the table below it." });
  const item = { plot, switched: new Map(), shown: "", drag: {}, title: make("h3"), note: make("p"),
    legend: make("div", { className: "legend" }), tools: make("div", { className: "tools" }) };
  item.numbers = numbersOf(chart.id, () => headerOf(item.chart), () => rowsOf(item.chart));
  item.figure = make("figure", {}, make("figcaption", {}, item.title, item.note), plot, item.legend, item.tools, item.numbers);
  addTools(item, chart.title);
  chartItems.set(chart.id, item);
  comingNear.observe(plot);
  return item;
}

/** One button for each name: a line and its band go together. */
function fillLegend(item) {
  const parts = [];
  for (const trace of item.traces.filter((one) => one.showlegend !== false && one.legendgroup)) {
    const on = trace.visible !== "legendonly";
    parts.push(make("button", { type: "button", "aria-pressed": String(on), title: "Show or hide",
      onclick: (event) => toggle(item, trace.legendgroup, event.currentTarget) }, swatch(trace), symbols(trace.legendgroup)));
  }
  const keys = new Map(item.chart.stretches.map(({ shade }) => [styles.shades[shade].meaning, styles.shades[shade].fill]));
  if (parts.length < 2 && !item.chart.map) parts.length = 0; // one alone needs no name
  for (const [name, fill] of keys) {
    const key = make("span", { className: "key" });
    key.style.background = fill;
    parts.push(make("span", { className: "soft" }, key, name));
  }
  item.legend.replaceChildren(...parts);
}

function toggle(item, group, button) {
  bringUpToDate(item);
  const on = button.getAttribute("aria-pressed") !== "true";
  button.setAttribute("aria-pressed", String(on));
  item.switched.set(group, on ? true : "legendonly");
  const indices = item.traces.map((trace, k) => (trace.legendgroup === group ? k : -1)).filter((k) => k >= 0);
  Plotly.restyle(item.plot, { visible: on ? true : "legendonly" }, indices);
}

const axesOf = (chart) => ["xaxis", ...chart.panels.map((_, k) => nth("yaxis", k))];

/** Zooms about the middle (factor below 1: closer) and moves by a part of the width. */
function zoom(item, factor, move = 0) {
  bringUpToDate(item);
  const [low, high] = item.plot._fullLayout.xaxis.range;
  const middle = (low + high) / 2 + move * (high - low), half = (factor * (high - low)) / 2;
  Plotly.relayout(item.plot, { "xaxis.range": [middle - half, middle + half] });
}

function showAll(item) {
  bringUpToDate(item);
  const whole = layoutOf(item.chart); // into the layout that it has the library writes the present range
  Plotly.relayout(item.plot, Object.fromEntries(axesOf(item.chart).map((name) =>
    (whole[name].range ? [`${name}.range`, whole[name].range] : [`${name}.autorange`, true]))));
}

/** Buttons, and the keys that do the same on a chart in focus. */
function addTools(item, title) {
  const move = (part) => () => zoom(item, 1, part), closer = () => zoom(item, 0.5), wider = () => zoom(item, 2);
  const keys = { "+": closer, "=": closer, "-": wider, ArrowLeft: move(-0.2), ArrowRight: move(0.2), 0: () => showAll(item) };
  item.plot.addEventListener("keydown", (event) => {
    const action = event.ctrlKey || event.altKey || event.metaKey ? null : keys[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
  for (const [text, what, action] of [["+", "Zoom in", closer], ["\u2212", "Zoom out", wider], ["All", "Show all", keys[0]],
    ["SVG", "Save as SVG", () => savePicture(item, "svg")], ["PNG", "Save as PNG", () => savePicture(item, "png")]]) {
    item.tools.append(make("button", { type: "button", title: what, "aria-label": `${what}: ${title}`, onclick: action }, text));
  }
}

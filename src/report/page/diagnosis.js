// What a diagnosis adds: the ladder of errors, where the law fails, what became of each effect.

function rungNames(diagnosis) {
  return diagnosis.ladder.map((rung, k) => (k === 0 ? pageData.law : `+ ${rung.added}`));
}

/** Share of the squares above the floor that is gone at each rung. */
function goneOf(diagnosis) {
  const above = (rung) => rung.held_out_rmse ** 2 - diagnosis.floor_rmse ** 2;
  const first = diagnosis.ladder.length > 0 ? above(diagnosis.ladder[0]) : NaN;
  return diagnosis.ladder.map((rung, k) => (k > 0 && first > 0 ? Math.min(1, 1 - above(rung) / first) : NaN));
}

function ladderChart(parent, diagnosis, unit) {
  const names = rungNames(diagnosis), gone = goneOf(diagnosis);
  const of = unit === "N" ? " N" : "";
  const traces = [{ type: "scatter", mode: "lines+markers", name: "error on data not seen", legendgroup: "error on data not seen",
    x: names.map(plain), y: diagnosis.ladder.map((r) => r.held_out_rmse),
    error_y: { type: "data", array: diagnosis.ladder.map((r) => r.held_out_std_error), thickness: 1.5, width: 6, color: "#000" },
    line: { color: ink.blue, dash: "solid", width: 2 }, marker: { symbol: "circle", size: 10, color: ink.blue },
    hovertemplate: `%{x}<br>%{y:.4g}${of}<extra></extra>` }];
  const shapes = [{ type: "line", xref: "paper", x0: 0, x1: 1, yref: "y", y0: diagnosis.floor_rmse, y1: diagnosis.floor_rmse,
    line: { color: "#000", width: 1.5, dash: "dash" } }];
  const annotations = [{ xref: "paper", x: 0, xanchor: "left", y: diagnosis.floor_rmse, yanchor: "bottom", showarrow: false,
    text: `floor ${number(diagnosis.floor_rmse, 3)}${of}` }];
  gone.forEach((share, k) => {
    if (!Number.isFinite(share)) return;
    annotations.push({ x: k, y: diagnosis.ladder[k].held_out_rmse, yanchor: "bottom", yshift: 22, bgcolor: "#fff", showarrow: false,
      text: `${percent(share)} gone` });
  });
  chart(parent, { id: "ladder", title: "The ladder: error on data not seen, as effects are added",
    note: "Bars are one standard error. At the floor only noise and scatter from cycle to cycle are left.", traces,
    layout: { xaxis: axis("", { type: "category", range: [-0.5, names.length - 0.5] }),
      yaxis: axis(`held-out RMSE [${unit}]`, { rangemode: "tozero" }), shapes, annotations },
    header: ["rung", "held_out_rmse", "std_error", "share_gone"],
    rows: () => diagnosis.ladder.map((r, k) => [names[k], r.held_out_rmse, r.held_out_std_error, gone[k] || 0]) });
}

function whereChart(parent, diagnosis) {
  const bars = (name, shares, colour, shape) => ({ type: "bar", orientation: "h", name, legendgroup: name,
    y: shares.map((s) => s.variable), x: shares.map((s) => 100 * s.share),
    marker: { color: ink[colour], line: { color: "#000", width: 1 },
      pattern: { shape, fillmode: "overlay", fgcolor: "#fff", size: 6, solidity: 0.35 } },
    hovertemplate: "%{y}: %{x:.3g} %<extra>%{fullData.name}</extra>" });
  const traces = [bars(pageData.law, diagnosis.where, "blue", "")];
  if (diagnosis.ladder.length > 1) traces.push(bars("final model", diagnosis.remaining, "red", "/"));
  chart(parent, { id: "where", title: "Where the error above the floor goes", note: pageData.where, traces,
    height: 120 + 34 * Math.max(diagnosis.where.length, 3),
    layout: { barmode: "group", xaxis: axis("share [%]", { range: [0, 105] }),
      yaxis: axis("", { type: "category", autorange: "reversed" }) },
    header: ["model", "variable", "share", "p_value"],
    rows: () => [...diagnosis.where.map((s) => [pageData.law, s.variable, s.share, s.p_value]),
      ...diagnosis.remaining.map((s) => ["final model", s.variable, s.share, s.p_value])] });
}

const statusOrder = ["missing", "equivalent", "superseded", "unsupported", "untestable"];
const statusSymbols = { missing: "circle", equivalent: "diamond", superseded: "square", unsupported: "triangle-down" };
const statusColours = { missing: "red", equivalent: "purple", superseded: "green", unsupported: "grey" };

function effectsInOrder(diagnosis) {
  const known = (e) => (e.held_out_rmse === null ? Infinity : e.held_out_rmse);
  return [...diagnosis.effects].sort((a, b) =>
    statusOrder.indexOf(a.status) - statusOrder.indexOf(b.status) || known(a) - known(b));
}

/** Held-out error with each candidate beside the law it was tried on. */
function candidatesChart(parent, diagnosis, unit) {
  const fitted = effectsInOrder(diagnosis).filter((e) => e.held_out_rmse !== null);
  if (fitted.length === 0) return;
  const traces = statusOrder.filter((status) => statusSymbols[status]).map((status) => {
    const own = fitted.filter((e) => e.status === status);
    return points(status, { x: own.map((e) => e.held_out_rmse), y: own.map((e) => plain(e.key)) },
      { colour: statusColours[status], symbol: statusSymbols[status], size: 10 },
      { hovertemplate: "%{y}<br>%{x:.4g}<extra>%{fullData.name}</extra>" });
  }).filter((trace) => trace.x.length > 0);
  const first = diagnosis.ladder.length > 0 ? diagnosis.ladder[0].held_out_rmse : null;
  const upright = (x, dash) => ({ type: "line", xref: "x", yref: "paper", x0: x, x1: x, y0: 0, y1: 1,
    line: { color: "#000", width: 1.2, dash } });
  chart(parent, { id: "candidates", title: "Each candidate: error on data not seen with it",
    note: "At the rung where it was judged last. Dashed: the floor; dotted: the bare law.",
    height: 90 + 22 * fitted.length, traces,
    layout: { xaxis: axis(`held-out RMSE [${unit}]`),
      yaxis: axis("", { type: "category", categoryorder: "array", categoryarray: fitted.map((e) => plain(e.key)).reverse() }),
      shapes: [upright(diagnosis.floor_rmse, "dash"), ...(first ? [upright(first, "dot")] : [])] },
    header: ["status", "held_out_rmse", "effect"] });
}

function candidatesTable(parent, diagnosis) {
  const value = (p) => `${p.name} = ${withError(p.value, p.std_error, p.unit === "1" ? "" : ` ${p.unit}`)}`;
  const rows = effectsInOrder(diagnosis).map((e) => [e.key, e.status, number(e.held_out_rmse, 3),
    percent(e.error_reduction), e.p_value === null ? "–" : e.p_value < 1e-4 ? "< 0.0001" : number(e.p_value, 2),
    e.status === "missing" || e.status === "equivalent" ? e.parameters.map(value).join("; ") : "", prose(e.reason)]);
  parent.append(make("details", { open: "", className: "effects" }, make("summary", {}, "What became of each effect"),
    table("", ["effect", "status", "held-out RMSE", "error taken away", "p", "parameters", "why"], rows, [2, 3, 4])));
}

function diagnosisSection(parent, diagnosis, unit) {
  const section = make("section", { id: "diagnosis" }, make("h2", {}, "What is missing"));
  parent.append(section);
  const pair = make("div", { className: "pair" });
  section.append(pair);
  if (diagnosis.ladder.length > 0) ladderChart(pair, diagnosis, unit);
  if (diagnosis.where.length > 0) whereChart(pair, diagnosis);
  const next = make("div", {}, make("h3", {}, "Next experiment"), make("p", {}, prose(diagnosis.next_experiment || "None is needed.")));
  if (diagnosis.formula) {
    next.append(make("h3", {}, "A closed form of what remains, for --formula"), make("pre", {}, diagnosis.formula));
  }
  for (const message of diagnosis.messages) next.append(make("p", {}, prose(message)));
  section.append(next);
  if (diagnosis.confirmations.length > 0) {
    section.append(table("Tried on runs that took no part, parameters frozen",
      ["run", "RMSE of the bare law", "RMSE of the final model", "p"],
      diagnosis.confirmations.map((c) => [c.path, number(c.base_rmse, 3), number(c.final_rmse, 3), number(c.p_value, 2)]),
      [1, 2, 3]));
  }
  candidatesChart(section, diagnosis, unit);
  candidatesTable(section, diagnosis);
}

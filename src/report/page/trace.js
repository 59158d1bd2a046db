// The charts of one trace: samples beside the laws, friction over speed, errors, cycles.

const modelStyles = [
  { colour: "black", dash: "solid" }, { colour: "purple", dash: "dashdot" }, { colour: "green", dash: "longdash" },
];
const publishedStyle = { colour: "grey", dash: "dot", width: 1.3 };
const branchStyles = {
  "speeding up": { colour: "blue", dash: "solid", symbol: "triangle-up" },
  "slowing down": { colour: "red", dash: "dash", symbol: "triangle-down" },
  slip: { colour: "blue", dash: "solid", symbol: "circle" },
};

/** How a model is drawn, the same in every chart. */
function styleOf(name, models) {
  const k = models.indexOf(name);
  return k < 0 ? publishedStyle : modelStyles[k % modelStyles.length];
}

function frictionTitle(trace) {
  return trace.friction_unit === "N" ? "friction force [N]" : "friction μ [1]";
}

const rect = (x0, x1, fillcolor, more = {}) => ({ type: "rect", layer: "below", xref: "x", yref: "paper", x0, x1, y0: 0,
  y1: 1, line: { width: 0 }, fillcolor, ...more });

/** Two charts, one above the other, over one abscissa. */
function stacked(xTitle, topTitle, bottomTitle, more = {}) {
  return { xaxis: axis(xTitle, { anchor: "y2", domain: [0, 1], ...more.xaxis }),
    yaxis: axis(topTitle, { domain: [0.46, 1], ...more.yaxis }),
    yaxis2: axis(bottomTitle, { domain: [0, 0.4], ...more.yaxis2 }), shapes: more.shapes || [],
    annotations: more.annotations || [] };
}

/** Lines of a window: friction with its models above, velocity with the disc below. x: turns times into what is shown. */
function windowTraces(trace, part, x, unit) {
  const moved = (series) => ({ x: series.x.map(x), y: series.y });
  const hover = (value, of) => ({ hovertemplate: `%{x} ${unit}<br>${value} %{y:.5g} ${of}<extra>%{fullData.name}</extra>` });
  const friction = hover(trace.friction_unit === "N" ? "force" : "μ", trace.friction_unit === "N" ? "N" : "");
  const speed = hover(trace.velocity === "v_b" ? "v_b" : "v_r", "mm/s");
  const traces = [line("measured", moved(part.friction), { colour: "blue", width: 1.1 }, friction)];
  (part.models || []).forEach((series, k) => {
    const style = styleOf(trace.models[k], trace.models);
    traces.push(line(trace.models[k], moved(series), { ...style, width: 2 },
      { ...friction, visible: k === 0 || pageData.kind === "diagnosis" ? true : "legendonly" }));
  });
  traces.push(line("measured", moved(part.velocity), { colour: "blue", width: 1.1 },
    { ...speed, yaxis: "y2", showlegend: false }));
  if (part.disc) {
    traces.push(line("ω r of the disc", moved(part.disc), { colour: "red", dash: "dash", width: 1.5 },
      { ...speed, yaxis: "y2" }));
  }
  return traces;
}

function velocityTitle(trace) {
  return `${trace.velocity === "v_b" ? "v<sub>b</sub>" : "v<sub>r</sub>"} [mm/s]`;
}

function cyclesChart(parent, trace, id) {
  const part = trace.cycles;
  const shapes = part.phases.map((p) => rect(p.from, p.to, p.phase === "stick" ? stickFill : slipFill));
  const phases = () => part.phases.map((p) => [p.phase, p.from, p.to]);
  const traces = windowTraces(trace, part, (t) => t, "s");
  chart(parent, { id: `${id}-cycles`, title: "Three cycles, measured and by the law",
    note: `Cycles ${part.first + 1} to ${part.first + 3}. In stick the spring sets friction, so the law speaks in slip only.`,
    height: 470, traces, keys: [["stick", stickFill], ["slip", slipFill]],
    layout: stacked("time [s]", frictionTitle(trace), velocityTitle(trace), { shapes, xaxis: { hoverformat: ".6g" } }),
    header: ["line", "time_s", `friction_${trace.friction_unit} or velocity_mm_s`],
    rows: () => [...rowsOf(traces), ...phases()] });
}

function zoomChart(parent, trace, part, id, title) {
  const shapes = [{ type: "line", xref: "x", yref: "paper", x0: 0, x1: 0, y0: 0, y1: 1,
    line: { color: "#444", width: 1, dash: "dot" } }];
  chart(parent, { id, title, note: `±5 ms about ${number(part.at, 6)} s; every sample${part.friction.x.length > 1000 ? ", reduced to what the eye can see" : ""}.`,
    height: 400, traces: windowTraces(trace, part, (t) => (t - part.at) * 1000, "ms"),
    layout: stacked("time from the event [ms]", frictionTitle(trace), velocityTitle(trace), { shapes }),
    header: ["line", "time_ms", `friction_${trace.friction_unit} or velocity_mm_s`] });
}

/** Friction over speed: branches as bands over cycles, laws with their 95 % bands, residuals below. */
function lawChart(parent, trace, id) {
  const unit = trace.friction_unit === "N" ? "N" : "";
  const traces = [];
  const hover = (what, of) => ({ hovertemplate: `%{x:.4g} mm/s<br>${what} %{y:.5g} ${of}<extra>%{fullData.name}</extra>` });
  for (const b of trace.branches) {
    const style = branchStyles[b.branch], name = `measured, ${b.branch}`;
    traces.push(...band(name, b.v, b.low, b.high, style.colour));
    traces.push(line(name, { x: b.v, y: b.middle }, style, hover("median", unit)));
  }
  if (trace.measures && trace.measures.break_away_friction.y.some((y) => y !== null)) {
    const level = trace.measures.break_away_friction;
    traces.push(points("break-away of each cycle", { x: level.y.map(() => 0), y: level.y },
      { colour: "grey", symbol: "diamond", size: 5 }, hover("break-away", unit)));
  }
  let fastest = 0, slowest = Infinity;
  for (const curve of pageData.curves) {
    const style = styleOf(curve.name, trace.models);
    const more = trace.models.includes(curve.name) ? {} : { visible: "legendonly" };
    fastest = Math.max(fastest, curve.fastest);
    slowest = Math.min(slowest, curve.slowest);
    traces.push(...band(curve.name, curve.v, curve.low, curve.high, style.colour, more));
    traces.push(line(curve.name, { x: curve.v, y: curve.mu }, { width: 2, ...style }, { ...hover("law", unit), ...more }));
  }
  traces.push(...residualTraces(trace));
  const right = 1.12 * fastest;
  const shapes = fastest > 0 ? [rect(fastest, 1.3 * fastest, beyondFill)] : [];
  if (slowest > 0 && slowest < fastest) shapes.push(rect(-fastest, slowest, beyondFill));
  shapes.push(...[-2, 2].map((y) => ({ type: "line", xref: "paper", x0: 0, x1: 1, yref: "y2", y0: y, y1: y,
    line: { color: "#888", width: 1, dash: "dot" } })));
  const annotations = fastest > 0 ? [{ x: right, xanchor: "right", y: 1, yanchor: "top", xref: "x", yref: "paper",
    text: "beyond<br>the data", showarrow: false, font: { size: 11, color: "#595959" } }] : [];
  chart(parent, { id: `${id}-law`, title: "Friction over relative velocity",
    note: "Bands of the measurement: 5 to 95 % of the cycles. Bands of the laws: 95 % interval. Below: what each law " +
      "leaves, in units of the floor of noise and scatter.",
    height: 560, traces, keys: [["beyond the data", beyondFill]],
    layout: stacked("relative velocity |v<sub>r</sub>| [mm/s]", frictionTitle(trace), "residual / floor [1]",
      { shapes, annotations, xaxis: { range: [-0.02 * right, right] } }),
    header: ["line", "relative_velocity_mm_s", `friction_${trace.friction_unit} or residual_over_floor`] });
}

/** Residuals of each model on both branches; switched with the line of their model. */
function residualTraces(trace) {
  const traces = [];
  trace.residuals.forEach((branches, k) => {
    const name = trace.models[k], own = styleOf(name, trace.models);
    const more = { yaxis: "y2", showlegend: false };
    for (const b of branches) {
      const branch = branchStyles[b.branch];
      if (k === 0) traces.push(...band(name, b.v, b.low, b.high, branch.colour, more));
      traces.push(line(name, { x: b.v, y: b.middle },
        { colour: k === 0 ? branch.colour : own.colour, dash: k === 0 ? branch.dash : own.dash,
          symbol: branch.symbol, width: 1.3 },
        { ...more, name: plain(`residual of ${name}, ${b.branch}`),
          hovertemplate: "%{x:.4g} mm/s<br>%{y:.3g} floors<extra>%{fullData.name}</extra>" }));
    }
  });
  return traces;
}

/** Relative error (Eq 5) over speed or time: the mean of each bin as a line, its largest as points. */
function errorChart(parent, trace, id, over, title, xTitle, unit) {
  const traces = [];
  trace.errors.forEach((error, k) => {
    const name = trace.models[k], style = styleOf(name, trace.models), e = error[over];
    const colour = ["blue", "red", "green"][k % 3], symbol = ["triangle-up", "square", "x"][k % 3];
    const hover = (what) => ({ hovertemplate: `%{x:.5g} ${unit}<br>${what} %{y:.3g}<extra>%{fullData.name}</extra>`,
      visible: k < 2 ? true : "legendonly" });
    traces.push(line(`${name}, mean`, { x: e.x, y: e.mean }, { colour, dash: style.dash }, hover("mean")));
    traces.push(points(`${name}, largest`, { x: e.x, y: e.largest }, { colour, symbol, size: 4 }, hover("largest")));
  });
  const shapes = [{ type: "line", xref: "paper", x0: 0, x1: 1, yref: "y", y0: 0.08, y1: 0.08,
    line: { color: "#000", width: 1.5, dash: "dash" } }];
  const annotations = [{ xref: "paper", x: 1, xanchor: "right", y: 0.08, yanchor: "bottom", text: "0.08",
    showarrow: false }];
  chart(parent, { id: `${id}-error-${over}`, title,
    note: "|(measured − law)/measured| of every slip sample, Eq 5. Each bin shows its mean and its largest.", traces,
    layout: { xaxis: axis(xTitle), yaxis: axis("relative error [1]", { rangemode: "tozero" }), shapes, annotations },
    header: ["line", xTitle, "relative_error"] });
}

/** Residual over cycle and phase of the slip; the colours also rise in lightness. */
function mapChart(parent, trace, id) {
  const map = trace.map;
  const all = map.residual.flat().filter((z) => z !== null).map(Math.abs).sort((a, b) => a - b);
  const most = Math.max(1, all[Math.floor(0.995 * (all.length - 1))] || 1);
  const rows = () => map.residual.flatMap((row, i) => row.map((z, k) => [map.cycle[i] + 1, map.phase[k], z]));
  chart(parent, { id: `${id}-map`, title: "What the law leaves over cycle and phase of the slip",
    note: `Mean residual of ${trace.models[0]} in units of the floor. Stripes along the slip: the law has the wrong ` +
      "shape. Changes from cycle to cycle: something moves with time or angle.", height: 360,
    traces: [{ type: "heatmap", name: "residual / floor", x: map.phase, y: map.cycle.map((c) => c + 1), z: map.residual,
      zmin: -most, zmax: most, colorscale: "Cividis", hoverongaps: false,
      colorbar: { title: { text: "floors", side: "right" }, thickness: 12 },
      hovertemplate: "phase %{x:.2f}<br>cycle %{y}<br>%{z:.2f} floors<extra></extra>" }],
    layout: { xaxis: axis("phase of the slip, 0 break-away to 1 re-stick [1]"), yaxis: axis("cycle") },
    header: ["cycle", "phase", "residual_over_floor"], rows });
}

function measureCharts(parent, trace, id) {
  const m = trace.measures;
  if (!m || m.break_away_friction.x.length < 2) return;
  const of = (name, series, colour, symbol, unit) => points(name, series, { colour, symbol, size: 5 },
    { hovertemplate: `%{x:.5g} s<br>%{y:.5g} ${unit}<extra>%{fullData.name}</extra>` });
  const unit = trace.friction_unit === "N" ? "N" : "";
  const one = (key, title, yTitle, traces) => chart(parent, { id: `${id}-${key}`, title, traces, height: 290,
    layout: { xaxis: axis("time of break-away [s]"), yaxis: axis(yTitle) }, header: ["measure", "time_s", yTitle] });
  one("levels", "Friction levels of each cycle", frictionTitle(trace), [
    of("break-away", m.break_away_friction, "blue", "circle", unit),
    of("largest in stick", m.static_friction, "red", "triangle-up", unit),
    of("least in slip", m.kinetic_friction, "green", "triangle-down", unit)]);
  one("peaks", "Fastest of each slip", "peak |v<sub>r</sub>| [mm/s]",
    [of("peak velocity", m.peak_velocity, "blue", "circle", "mm/s")]);
  one("times", "Durations of each cycle", "duration [ms]", [
    of("stick", m.stick_time, "blue", "circle", "ms"), of("slip", m.slip_time, "red", "triangle-up", "ms"),
    of("period", m.period, "green", "square", "ms")]);
}

function spectrumChart(parent, trace, id, peak) {
  const shapes = peak && peak.peak_hz > 0 ? [{ type: "line", xref: "x", yref: "paper", x0: peak.peak_hz, x1: peak.peak_hz,
    y0: 0, y1: 1, line: { color: "#444", width: 1, dash: "dot" } }] : [];
  chart(parent, { id: `${id}-spectrum`, title: "Spectrum of the relative velocity", height: 290,
    note: peak && peak.peak_hz > 0 ? `Strongest line at ${number(peak.peak_hz)} Hz (dotted). Hann window over the whole record.` : null,
    traces: [line("amplitude", trace.spectrum, { colour: "blue", width: 1.2 },
      { hovertemplate: "%{x:.5g} Hz<br>%{y:.4g} mm/s<extra></extra>" })],
    layout: { xaxis: axis("frequency [Hz]"), yaxis: axis("amplitude of v<sub>r</sub> [mm/s]", { rangemode: "tozero" }), shapes },
    header: ["line", "frequency_hz", "amplitude_mm_s"] });
}

function recordChart(parent, trace, id) {
  chart(parent, { id: `${id}-record`, title: "The whole record",
    note: "Every stretch is drawn from its least to its largest sample, so that no peak is lost.", height: 400,
    traces: windowTraces(trace, trace.record, (t) => t, "s"),
    layout: stacked("time [s]", frictionTitle(trace), velocityTitle(trace)),
    header: ["line", "time_s", `friction_${trace.friction_unit} or velocity_mm_s`] });
}

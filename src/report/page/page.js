// Puts the page together: header, sections, tables, what was run.

const pageData = JSON.parse(document.getElementById("data").textContent);
const lists = (value) => (Array.isArray(value) ? value : value ? [value] : []);

function header(main) {
  const { result } = pageData;
  const traces = lists(result.traces || result.trace), conditions = lists(result.conditions);
  main.append(make("h1", {}, pageData.title),
    make("p", { className: "soft" }, `${pageData.kind === "diagnosis" ? "Diagnosis" : "Friction law"} by ` +
      `${result.tool.name} ${result.tool.version}`),
    make("p", { className: "verdict" }, prose(pageData.verdict.replace("stands above", "stands below"))));
  for (const warning of result.warnings) main.append(make("p", { className: "warning" }, make("strong", {}, "Warning: "), prose(warning)));
  if (traces.length !== 1) return;
  const t = traces[0], c = conditions[0], s = lists(result.stick_slip)[0];
  const from = (source) => (source ? ` (${source})` : "");
  const ms = (seconds) => (seconds === null ? null : 1000 * seconds);
  const measured = (value, error, unit) => (value === null || !Number.isFinite(value) ? "" : withError(value, error, unit));
  main.append(facts([
    ["Record", `${t.samples.toLocaleString("en").replace(/,/g, " ")} samples, ${brief(t.duration_s)} s at ${brief(t.rate_hz / 1000)} kHz`],
    ["Radius", c.radius_mm === null ? "" : `${brief(c.radius_mm)} mm${from(c.radius_source)}`],
    ["Disc speed", c.speed_rpm === null ? "" : `${brief(c.speed_rpm)} rpm${from(c.speed_source)}`],
    ["Load", c.load_N === null ? "" : `${brief(c.load_N)} N${from(c.load_source)}`],
    ["Cycles with a stick and a slip", s.motion === "stick-slip" ? String(s.cycles) : s.motion],
    ["Frequency", measured(s.frequency_hz.value, s.frequency_hz.std_error, " Hz")],
    ["Amplitude of v_r", measured(s.amplitude_mm_s, s.amplitude_std_error_mm_s, " mm/s")],
    ["Stick time", measured(ms(s.stick_time_s), ms(s.stick_time_std_error_s), " ms")],
    ["Slip time", measured(ms(s.slip_time_s), ms(s.slip_time_std_error_s), " ms")]]),
  make("p", { className: "soft" }, "± is one standard error, everywhere on this page."));
}

function navigation(main) {
  const links = [["diagnosis", "What is missing"], ["trace", "Model and measurement"], ["law", "Friction law"],
    ["errors", "Errors"], ["cycles", "Cycles and spectrum"], ["run", "What was run"]]
    .filter(([id]) => document.getElementById(id));
  const list = make("nav", { "aria-label": "Sections" }, make("ul", {},
    ...links.map(([id, name]) => make("li", {}, make("a", { href: `#${id}` }, name)))));
  main.querySelector(".verdict").after(list);
}

function healthTable(parent) {
  const health = pageData.result.health, several = health.some((item) => item.trace !== undefined);
  const rank = { problem: 0, warning: 1, ok: 2 }, sign = { problem: "✕\u00a0problem", warning: "!\u00a0warning", ok: "✓\u00a0ok" };
  const rows = [...health].sort((a, b) => rank[a.status] - rank[b.status])
    .map((item) => [...(several ? [pageData.result.traces[item.trace].path] : []), item.check, sign[item.status], prose(item.message)]);
  parent.append(table("Health of the data", [...(several ? ["trace"] : []), "check", "status", "what was found"], rows));
}

function parameterTables(parent) {
  const fits = pageData.result.fits;
  const systematic = pageData.instruments_declared;
  const profile = pageData.models.some((model) => model.rows.some((row) => row[6] !== "-"));
  const columns = [0, 1, 2, 3, 4, ...(systematic ? [5] : []), ...(profile ? [6] : []), 7];
  const names = ["parameter", "value", "unit", "std error", "95 % interval", "systematic", "95 % by profile", "remarks"];
  pageData.models.forEach((model, k) => {
    const fit = fits[k], e = fit.error;
    const numeric = columns.map((c, at) => ([1, 3, 4, 5, 6].includes(c) ? at : -1)).filter((at) => at >= 0);
    parent.append(make("h3", {}, `${model.name}${model.best && fits.length > 1 ? " (best)" : ""}`),
      make("p", { className: "soft" }, model.law),
      ...model.effects.map((effect) => make("p", { className: "soft" }, `${effect.key}: ${effect.equation}`)));
    if (!fit.converged) parent.append(make("p", { className: "warning" }, "Did not converge: this is not a fit to rely on."));
    if (model.rows.length > 0) {
      parent.append(table("", columns.map((c) => names[c]), model.rows.map((row) => columns.map((c) => row[c])), numeric),
        make("p", { className: "soft" }, `RMSE ${number(e.rmse, 3)}, on data not seen ${number(e.held_out_rmse, 3)}; floor ` +
          `${number(fit.floor_rmse, 3)} (noise ${number(fit.floor.noise, 3)}, break-away scatter ${number(fit.floor.scatter, 3)}). ` +
          `Relative error mean ${percent(e.mean_relative)}, largest ${percent(e.max_relative)}; ` +
          `${percent(fit.explained)} of the error above the floor is explained.`));
    }
    for (const c of fit.messages.some((m) => m.includes("correlated")) ? [] : fit.correlations) {
      parent.append(make("p", { className: "soft" }, `${c.parameters.join(" and ")} are correlated by ${number(c.value, 3)}.`));
    }
    for (const message of fit.messages) parent.append(make("p", { className: "soft" }, `Note: ${prose(message)}`));
  });
  parent.append(make("p", { className: "soft" }, systematic
    ? "Intervals are statistical, from cycle to cycle; systematic is one standard uncertainty from the declared instruments, not part of them."
    : "Intervals are statistical, from cycle to cycle; no instrument uncertainties were declared (--instruments), so there is no systematic part."));
  if (pageData.protocols && pageData.protocols.length > 0) {
    parent.append(table("Published protocol beside the joint fit",
      ["law", "parameter", "published", "joint", "difference", "unit", "remarks"], pageData.protocols, [2, 3, 4]),
    make("p", { className: "soft" }, "The published protocol takes mu_s and mu_k from the extremes of each cycle, which noise widens."));
  }
  for (const sentence of pageData.laws || []) parent.append(make("p", {}, `${prose(sentence)}.`));
}

/** Everything drawn of one trace, into sections that the page has once. */
function traceCharts(sections, trace, id, peak) {
  if (trace.cycles) cyclesChart(sections.trace, trace, id);
  const pair = () => make("div", { className: "pair" });
  const zooms = pair();
  sections.trace.append(zooms);
  if (trace.break_away) zoomChart(zooms, trace, trace.break_away, `${id}-break-away`, "Break-away");
  if (trace.restick) zoomChart(zooms, trace, trace.restick, `${id}-restick`, "Re-stick");
  if (!trace.cycles && trace.record) recordChart(sections.trace, trace, id);
  if (trace.branches) lawChart(sections.law, trace, id);
  if (trace.errors && trace.errors.length > 0) {
    const errors = pair();
    sections.errors.append(errors);
    errorChart(errors, trace, id, "over_speed", "Relative error over speed", "relative velocity |v<sub>r</sub>| [mm/s]", "mm/s");
    errorChart(errors, trace, id, "over_time", "Relative error over time", "time [s]", "s");
    if (trace.map) mapChart(sections.errors, trace, id);
  }
  const cycles = pair();
  sections.cycles.append(cycles);
  measureCharts(cycles, trace, id);
  if (trace.spectrum) spectrumChart(cycles, trace, id, peak);
  if (trace.cycles && trace.record) recordChart(sections.cycles, trace, id);
}

function runSection(main) {
  const { result } = pageData;
  const section = make("section", { id: "run" }, make("h2", {}, "What was run"));
  section.append(make("p", {}, "This page is made by"), make("pre", {}, pageData.command));
  const traces = lists(result.traces || result.trace);
  section.append(table("Input", ["file", "samples", "duration [s]", "checksum of the rows (FNV-1a)"],
    traces.map((t) => [t.path, String(t.samples), number(t.duration_s), t.checksum]), [1, 2]));
  const notes = traces.flatMap((t) => t.notes);
  if (notes.length > 0) section.append(make("h3", {}, "How the input was read"), make("ul", {}, ...notes.map((n) => make("li", {}, prose(n)))));
  section.append(make("p", {}, `Next, ${pageData.next.reason}:`), make("pre", {}, pageData.next.command),
    make("p", { className: "soft" }, `${result.tool.name} ${result.tool.version}. Charts by plotly.js (MIT licence).`));
  main.append(section);
}

function build() {
  const main = document.getElementById("page");
  main.replaceChildren();
  document.title = `${pageData.title} – ${pageData.kind === "diagnosis" ? "diagnosis" : "friction law"}`;
  header(main);
  const unit = pageData.traces.length > 0 ? pageData.traces[0].friction_unit : "1";
  if (pageData.result.diagnosis) diagnosisSection(main, pageData.result.diagnosis, unit);
  const sections = {};
  for (const [id, title] of [["trace", "Model and measurement"], ["law", "Friction law"], ["errors", "Errors"],
    ["cycles", "Cycles and spectrum"]]) {
    sections[id] = make("section", { id }, make("h2", {}, title));
  }
  const all = lists(pageData.result.traces || pageData.result.trace);
  const stickSlip = lists(pageData.result.stick_slip);
  pageData.traces.forEach((trace, k) => {
    if (pageData.traces.length > 1) {
      for (const section of Object.values(sections)) section.append(make("h3", {}, trace.path));
    }
    traceCharts(sections, trace, `t${k + 1}`, (stickSlip[k] || {}).spectrum);
  });
  if (all.length > pageData.traces.length) {
    sections.trace.append(make("p", {}, `The first ${pageData.traces.length} of ${all.length} traces are drawn.`));
  }
  healthTable(sections.trace);
  if (pageData.models.length > 0) parameterTables(sections.law);
  for (const section of Object.values(sections)) {
    if (section.childElementCount > 1 && section.textContent !== section.firstChild.textContent) main.append(section);
  }
  runSection(main);
  navigation(main);
  requestAnimationFrame(() => setTimeout(drawWaiting, 0));
}

build();

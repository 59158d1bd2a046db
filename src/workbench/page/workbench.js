// The workbench: controls (controls.js, brush.js) beside the report of the model they choose
// (include/tribofit/workbench/server.hpp). Every change asks the server for the picture of the new choice; answers that come
// late are dropped.

const workbench = {
  token: new URLSearchParams(location.search).get("token") || "",
  page: Array.from(crypto.getRandomValues(new Uint8Array(8)), (b) => b.toString(16).padStart(2, "0")).join(""),
  turn: 0, asking: null, settling: 0, polling: 0, choice: null, rung: null, world: null, changedAt: 0,
  plausible: new Map(), unfolded: new Set(), past: [], shownChoice: null, formulaPending: false,
};

/** Asks the server; a refusal is thrown as what it says. */
async function ask(path, body, signal) {
  let response;
  try {
    response = await fetch(path, { method: body ? "POST" : "GET", signal, cache: "no-store",
      headers: { "X-Workbench-Token": workbench.token, ...(body ? { "Content-Type": "application/json" } : {}) },
      body: body ? JSON.stringify(body) : undefined });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw { unanswered: true, problem: "The workbench does not answer", why: "identify explore has ended, or its machine is busy",
      suggestion: "start it again and open the address it prints; a saved session brings the models back" };
  }
  const answer = await response.json().catch(() => null);
  if (response.ok && answer) return answer;
  throw answer && answer.problem ? answer : { problem: "The request failed", why: `status ${response.status}`, suggestion: "" };
}

// ---- what is shown ----

/** Says what went wrong: at the formula where that is what changed and the workbench refused it, else on top. */
function showTrouble(trouble) {
  const places = ["workbench-trouble", "formula-trouble"].map((id) => document.getElementById(id));
  const box = places[workbench.formulaPending && !(trouble && trouble.unanswered) ? 1 : 0] || places[0];
  for (const other of places) if (other && other !== box) other.hidden = true;
  const field = document.getElementById("workbench-formula");
  if (field) field.setAttribute("aria-invalid", String(Boolean(trouble) && box === places[1]));
  const sentence = (text) => (text ? `${prose(text).replace(/[.\s]+$/, "")}. ` : "");
  box.textContent = trouble ? sentence(trouble.problem) + sentence(trouble.why) + sentence(trouble.suggestion) : "";
  box.hidden = !trouble;
}

const withUnit = (value, unit, digits = 4) => `${number(value, digits)}${unit && unit !== "1" ? ` ${unit}` : ""}`;

function showStatus(rung) {
  const ratio = rung.floor_rmse > 0 ? rung.held_out_rmse / rung.floor_rmse : null;
  document.getElementById("shown-model").textContent = rung.name;
  document.getElementById("shown-error").textContent = withUnit(rung.held_out_rmse, rung.unit);
  document.getElementById("shown-about").textContent =
    `± ${number(rung.held_out_std_error, 2)}${ratio ? `, ${number(ratio, 3)} times the noise floor` : ""}; ` +
    `${rung.cycles}${rung.cycles < workbench.world.cycles ? ` of ${workbench.world.cycles}` : ""} cycles; ` +
    (rung.full ? "final fit" : "quick fit, being refined");
  const gauge = document.getElementById("shown-gauge");
  const most = Math.max(rung.held_out_rmse, rung.floor_rmse, 1e-300) * 1.05;
  gauge.style.setProperty("--error", `${(100 * rung.held_out_rmse) / most}%`);
  gauge.style.setProperty("--floor", `${(100 * rung.floor_rmse) / most}%`);
  document.getElementById("workbench-command").textContent = rung.command;
  document.getElementById("workbench-undo").disabled = workbench.past.length === 0;
}

function showRungs(rungs) {
  const worst = Math.max(...rungs.map((rung) => rung.held_out_rmse || 0), 1e-300);
  const best = Math.min(...rungs.map((rung) => (rung.held_out_rmse > 0 ? rung.held_out_rmse : Infinity)));
  const rows = rungs.map((rung) => {
    const bar = make("span", { className: "bar", "aria-hidden": "true" });
    bar.style.background = styles.colours.blue;
    bar.style.width = `${(100 * rung.held_out_rmse) / worst}%`;
    const current = workbench.rung && rung.number === workbench.rung.number;
    const back = make("button", { type: "button", "aria-current": current ? "true" : null, "data-rung": rung.number,
      onclick: () => goTo(rung.choice) }, rung.name);
    const more = `on all data ${number(rung.rmse)}, noise floor ${number(rung.floor_rmse)}, ${rung.cycles} cycles`;
    return make("tr", { className: current ? "current" : "", title: more }, make("td", { className: "number" }, String(rung.number + 1)),
      make("td", {}, back, partOf(rung.choice)),
      make("td", { className: "number" }, number(rung.held_out_rmse), make("span", { className: "soft" },
        ` ± ${number(rung.held_out_std_error, 2)}`)),
      make("td", { className: "bars" }, bar, rung.held_out_rmse === best ? make("span", { className: "soft" }, "least") : null));
  });
  const head = ["", "Model", "Held-out error", "Bar"];
  const box = document.getElementById("workbench-rungs");
  box.replaceChildren(make("table", {}, make("caption", {}, "Models visited"),
    make("thead", {}, make("tr", {}, ...head.map((name) => make("th", { scope: "col" }, name)))), make("tbody", {}, ...rows)));
  const current = box.querySelector(".current");
  if (current) box.scrollTop = Math.max(0, current.offsetTop - box.clientHeight / 2);
}

/** What a choice has besides law and effects. */
function partOf(choice) {
  const parts = [];
  const given = new Set([...Object.keys(choice.start), ...Object.keys(choice.bounds)]);
  if (given.size) parts.push(`${[...given].join(", ")} set`);
  if (choice.cycles) parts.push(`cycles ${choice.cycles[0]} to ${choice.cycles[1]}`);
  if (choice.excluded.length) parts.push(`without ${choice.excluded.map(([a, b]) => `${number(a)} to ${number(b)} s`).join(", ")}`);
  return parts.length ? make("span", { className: "soft" }, ` ${parts.join("; ")}`) : null;
}

// ---- asking ----

/** Shows the picture of the choice; quick at first, then as the command line fits it. */
async function show(full = false, passing = false) {
  clearTimeout(workbench.settling);
  if (workbench.asking) workbench.asking.abort();
  const asking = new AbortController(), turn = ++workbench.turn;
  workbench.asking = asking;
  if (!full) workbench.changedAt = performance.now();
  document.documentElement.dataset.workbench = "asking";
  try {
    const answer = await ask("/api/show", { page: workbench.page, turn, full, passing, choice: workbench.choice }, asking.signal);
    if (answer.superseded || turn !== workbench.turn) return;
    workbench.rung = answer.rung;
    if (!passing) dragging = null; // a line by hand that comes now would stand on the chart of the fit
    showTrouble(null);
    workbench.formulaPending = false;
    remember(passing);
    showStatus(answer.rung);
    if (!full || !sameNames(answer.rung)) showParameters(answer.rung);
    else updateParameters(answer.rung);
    showPicture(answer.report);
    showRungs(answer.rungs); // in the colours of the report
    if (!full) document.documentElement.dataset.answerMs = (performance.now() - workbench.changedAt).toFixed(0);
    document.documentElement.dataset.workbench = answer.rung.full ? "settled" : "shown";
    if (!answer.rung.full) workbench.settling = setTimeout(() => show(true), 600);
  } catch (trouble) {
    if (trouble.name === "AbortError" || turn !== workbench.turn) return;
    if (!trouble.problem) throw trouble;
    showTrouble(trouble);
    document.documentElement.dataset.workbench = "failed";
  }
}

const otherWindows = new BroadcastChannel("tribofit workbench");

/** What undo goes back to, and what a reload begins with; other windows of this session show it in their ladders. */
function remember(passing) {
  const now = JSON.stringify(workbench.choice);
  if (passing || workbench.shownChoice === now) return;
  if (workbench.shownChoice) workbench.past.push(workbench.shownChoice);
  workbench.shownChoice = now;
  history.replaceState(JSON.parse(now), "");
  otherWindows.postMessage("");
}

function undo() {
  if (workbench.past.length === 0) return;
  const before = JSON.parse(workbench.past.pop());
  workbench.shownChoice = null; // what is undone is not gone back to
  goTo(before);
}

/** Friction over v_r with its residuals first, then the trace; what is read, not looked at, comes after. */
function showPicture(report) {
  const charts = (section) => section.items.filter((item) => item.type === "chart");
  const rest = (section) => ({ ...section, items: section.items.filter((item) => item.type !== "chart") });
  const law = report.sections.find((section) => section.id === "law");
  const trace = report.sections.find((section) => section.id === "trace");
  const sections = [...(law ? [{ id: "picture", title: "Friction over relative velocity", items: charts(law) }] : []),
    ...(trace ? [{ ...trace, items: charts(trace) }] : []), ...(law ? [rest(law)] : []),
    ...report.sections.filter((section) => section !== law && section !== trace),
    ...(trace ? [{ ...rest(trace), id: "health", title: "Health of the data" }] : [])];
  const box = document.getElementById("workbench-picture");
  showReport(box, { ...report, sections: sections.filter((section) => section.items.length > 0) });
  document.getElementById("workbench-facts").replaceChildren(make("summary", {}, "The record and the result in numbers"),
    ...box.querySelectorAll(":scope > .verdict, :scope > .facts"));
  addBrushes(box);
}

let dragging = null;
/** Draws the law with parameters as they stand under the hand, at once; fits come after. */
async function drawByHand(values) {
  if (dragging) dragging.abort();
  const asking = new AbortController();
  dragging = asking;
  let curve;
  try {
    curve = await ask("/api/curve", { choice: workbench.choice, values }, asking.signal);
  } catch {
    return; // an answer that came too late, or a model that was never fitted: the fit says more
  }
  if (dragging !== asking) return;
  const item = [...chartItems.values()].find((one) => one.chart.id.endsWith("-law") && one.plot.isConnected);
  if (item && isWithin(item, innerHeight)) await addLineByHand(item, curve);
  document.documentElement.dataset.byHand = JSON.stringify(values);
}

async function addLineByHand(item, curve) {
  bringUpToDate(item);
  const name = "by hand", at = item.plot.data.findIndex((trace) => trace.name === name);
  if (at >= 0) {
    await Plotly.restyle(item.plot, { x: [curve.x], y: [curve.y] }, [at]);
  } else {
    await Plotly.addTraces(item.plot, { type: "scatter", mode: "lines", name, x: curve.x, y: curve.y, hoverinfo: "name",
      line: { color: styles.colours.red, dash: "dot", width: 3 } });
  }
}

let changing = 0;
/** After a change of the choice. A drag changes it many times a second and waits for the hand to slow down. */
function changed(passing = false) {
  clearTimeout(changing);
  clearTimeout(workbench.settling);
  if (passing) changing = setTimeout(() => show(false, true), 25);
  else show();
}

function goTo(choice, full = false) {
  clearTimeout(changing); // a drag that was under way is of the choice before
  workbench.choice = structuredClone(choice);
  fillControls();
  show(full);
}

// ---- diagnosis and session ----

function diagnosisBox() {
  return make("div", { id: "diagnosis-box" },
    make("progress", { id: "workbench-progress", max: "1", value: "0", hidden: "", "aria-label": "Progress of the diagnosis" }),
    make("p", { id: "workbench-doing", role: "status" }), make("div", { id: "workbench-finding" }));
}

async function beginDiagnosis() {
  try {
    await ask("/api/diagnose", { choice: workbench.choice });
    followDiagnosis();
  } catch (trouble) {
    showTrouble(trouble);
  }
}

async function followDiagnosis() {
  clearTimeout(workbench.polling);
  let state;
  try {
    state = await ask("/api/diagnosis");
  } catch (trouble) {
    showTrouble(trouble);
    return;
  }
  const running = state.state === "running";
  document.getElementById("workbench-diagnose").disabled = running;
  document.getElementById("workbench-cancel").disabled = !running;
  const progress = document.getElementById("workbench-progress");
  progress.hidden = !running;
  progress.value = state.part;
  document.getElementById("workbench-doing").textContent = running ? prose(state.doing) : prose(state.sentence || "");
  document.documentElement.dataset.diagnosis = state.state;
  if (running) workbench.polling = setTimeout(followDiagnosis, 300);
  else showFinding(state);
}

function showFinding(state) {
  const box = document.getElementById("workbench-finding");
  if (state.state !== "done" || state.ladder.length === 0) {
    box.replaceChildren();
    return;
  }
  const rows = state.ladder.map((step) => [step.added ? `+ ${step.added}` : `${state.found.law} law`,
    `${number(step.held_out_rmse)} ± ${number(step.held_out_std_error, 2)}`]);
  const section = make("section", { id: "workbench-plan" });
  if (state.plan) fillSection(section, state.plan);
  box.replaceChildren(table("Ladder of the diagnosis", ["Rung", "Held-out error"], [...rows, ["Noise floor", number(state.floor_rmse)]], [1]),
    make("div", { className: "row" },
      make("button", { type: "button", id: "take-finding", onclick: () => goTo(state.found, true) }, "Show the model found"),
      state.leaves_open && !state.plan ? make("button", { type: "button", id: "workbench-plan-runs",
        title: "Simulate the runs that could distinguish what this record leaves open", onclick: beginPlan }, "What to run next") : null),
    make("pre", {}, state.command), section);
}

async function beginPlan(event) {
  event.target.disabled = true;
  try {
    await ask("/api/plan", {});
    followDiagnosis();
  } catch (trouble) {
    event.target.disabled = false;
    showTrouble(trouble);
  }
}

async function saveSession() {
  try {
    const session = await ask("/api/session");
    const name = workbench.world.trace.path.split("/").pop().replace(/\.[^.]*$/, "");
    save(`${name}-session.json`, new Blob([JSON.stringify(session, null, 2)], { type: "application/json" }));
  } catch (trouble) {
    showTrouble(trouble);
  }
}

function commandBox() {
  const copy = async (event) => {
    try {
      await navigator.clipboard.writeText(document.getElementById("workbench-command").textContent);
      event.target.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(document.getElementById("workbench-command"));
    }
  };
  return make("fieldset", {}, make("legend", { className: "visually-hidden" }, "The same from the command line"), make("pre", { id: "workbench-command" }),
    make("div", { className: "row" }, make("button", { type: "button", onclick: copy }, "Copy"),
      make("button", { type: "button", id: "workbench-save", onclick: saveSession }, "Save session")));
}

// ---- the page ----

/** What is always in view: the model, its error against the noise floor, and what one does most. */
function strip() {
  return make("header", { id: "workbench-status", className: "strip" },
    make("div", { className: "model", role: "status", "aria-live": "polite" }, make("div", { id: "shown-model" }),
      make("div", {}, "held-out error ", make("strong", { id: "shown-error" }, "–"), " ",
        make("span", { id: "shown-about", className: "soft" }))),
    make("div", { id: "shown-gauge", className: "gauge", "aria-hidden": "true" }, make("span", {}, "noise floor")),
    make("div", { className: "row" },
      make("button", { type: "button", id: "workbench-undo", disabled: "", onclick: undo }, "Undo"),
      make("button", { type: "button", id: "workbench-diagnose", title: "Try every effect of the catalogue and your formulas on blocks of cycles that are held out",
        onclick: beginDiagnosis }, "Diagnose"),
      make("button", { type: "button", id: "workbench-cancel", disabled: "",
        onclick: () => ask("/api/cancel", {}).catch(showTrouble) }, "Cancel")));
}

const folded = (title, ...parts) => make("details", {}, make("summary", {}, title), ...parts);

async function startWorkbench(main) {
  document.body.classList.add("workbench");
  changesUnderHand = true;
  const controls = make("aside", { id: "workbench-controls", "aria-label": "Model" });
  main.replaceChildren(strip(), controls, make("div", { id: "workbench-shown" },
    make("p", { id: "workbench-trouble", className: "warning", role: "alert", hidden: "" }), diagnosisBox(),
    make("div", { id: "workbench-picture" }), make("details", { id: "workbench-facts" })));
  try {
    workbench.world = await ask("/api/begin");
  } catch (trouble) {
    showTrouble(trouble);
    return;
  }
  workbench.choice = history.state || workbench.world.begin;
  controls.append(
    make("section", { id: "workbench-rungs", "aria-label": "Ladder of models", className: "scroll", tabindex: "0" }),
    lawChoice(), effectChoices(),
    folded("Parameters: starts and bounds", make("ul", { id: "workbench-messages" }), make("div", { id: "workbench-parameters" })),
    folded("An effect of your own", formulaChoice()), folded("Part of the record", selectionChoice()),
    folded("Radius, speed and load", conditionsChoice()),
    folded("The same from the command line", commandBox()));
  otherWindows.onmessage = () => ask("/api/begin").then((world) => showRungs(world.rungs)).catch(() => {});
  fillControls();
  await show();
  followDiagnosis();
}

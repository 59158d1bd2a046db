// The workbench: controls (controls.js) beside the report of the model they choose (include/tribofit/workbench/server.hpp). Every
// change asks the server for the picture of the new choice; answers that come late are dropped.

const workbench = {
  token: new URLSearchParams(location.search).get("token") || "",
  page: Array.from(crypto.getRandomValues(new Uint8Array(8)), (b) => b.toString(16).padStart(2, "0")).join(""),
  turn: 0, asking: null, settling: 0, polling: 0, choice: null, rung: null, world: null, changedAt: 0,
  plausible: new Map(), unfolded: new Set(),
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
    throw { problem: "The workbench does not answer", why: "identify explore has ended, or its machine is busy",
      suggestion: "start it again and open the address it prints; a saved session brings the models back" };
  }
  const answer = await response.json().catch(() => null);
  if (response.ok && answer) return answer;
  throw answer && answer.problem ? answer : { problem: "The request failed", why: `status ${response.status}`, suggestion: "" };
}

// ---- what is shown ----

function showTrouble(trouble) {
  const box = document.getElementById("workbench-trouble");
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
    `± ${number(rung.held_out_std_error, 2)}, RMSE on cycles not used in the fit (blocks held out in turn); ` +
    `${ratio ? `${number(ratio, 3)} times the noise floor, ` : ""}` +
    `${rung.cycles}${rung.cycles < workbench.world.cycles ? ` of ${workbench.world.cycles}` : ""} cycles; ` +
    (rung.full ? "the fit of the command at the foot of this page" : "quick fit, being refined");
  document.getElementById("workbench-command").textContent = rung.command;
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
    return make("tr", { className: current ? "current" : "" }, make("td", { className: "number" }, String(rung.number + 1)),
      make("td", {}, back, partOf(rung.choice)),
      make("td", { className: "number" }, `${number(rung.held_out_rmse)} ± ${number(rung.held_out_std_error, 2)}`),
      make("td", { className: "bars" }, bar, rung.held_out_rmse === best ? make("span", { className: "soft" }, "least") : null),
      make("td", { className: "number" }, number(rung.rmse)), make("td", { className: "number" }, number(rung.floor_rmse)),
      make("td", { className: "number" }, String(rung.cycles)));
  });
  const head = ["", "Model", "Held-out error", "", "On all data", "Floor", "Cycles"];
  document.getElementById("workbench-rungs").replaceChildren(make("table", {}, make("caption", {}, "Models visited"),
    make("thead", {}, make("tr", {}, ...head.map((name) => make("th", { scope: "col" }, name)))), make("tbody", {}, ...rows)));
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
    showTrouble(null);
    showStatus(answer.rung);
    if (!full || !sameNames(answer.rung)) showParameters(answer.rung);
    else updateParameters(answer.rung);
    showReport(document.getElementById("workbench-picture"), answer.report);
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

let changing = 0;
/** After a change of the choice; a drag changes it many times a second. */
function changed(passing = false) {
  clearTimeout(changing);
  clearTimeout(workbench.settling);
  changing = setTimeout(() => show(false, passing), 25);
}

function goTo(choice) {
  clearTimeout(changing); // a drag that was under way is of the choice before
  workbench.choice = structuredClone(choice);
  fillControls();
  show();
}

// ---- diagnosis and session ----

function diagnosisBox() {
  return make("fieldset", {}, make("legend", {}, "Diagnosis"),
    make("p", { className: "soft" }, "Tries every effect of the catalogue and your formulas on blocks of cycles that are held out."),
    make("div", { className: "row" },
      make("button", { type: "button", id: "workbench-diagnose", onclick: beginDiagnosis }, "Diagnose"),
      make("button", { type: "button", id: "workbench-cancel", disabled: "",
        onclick: () => ask("/api/cancel", {}).catch(showTrouble) }, "Cancel")),
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
  box.replaceChildren(table("Ladder of the diagnosis", ["Rung", "Held-out error"], [...rows, ["Floor", number(state.floor_rmse)]], [1]),
    make("button", { type: "button", id: "take-finding", onclick: () => goTo(state.found) }, "Show the model found"),
    make("pre", {}, state.command));
}

async function saveSession() {
  try {
    const session = await ask("/api/session");
    const url = URL.createObjectURL(new Blob([JSON.stringify(session, null, 2)], { type: "application/json" }));
    make("a", { href: url, download: `${workbench.world.trace.path.split("/").pop().replace(/\.[^.]*$/, "")}-session.json` }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
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
  return make("fieldset", {}, make("legend", {}, "The same from the command line"), make("pre", { id: "workbench-command" }),
    make("div", { className: "row" }, make("button", { type: "button", onclick: copy }, "Copy"),
      make("button", { type: "button", id: "workbench-save", onclick: saveSession }, "Save session")));
}

// ---- the page ----

function statusBox() {
  return make("div", { id: "workbench-status", role: "status", "aria-live": "polite" },
    make("div", { id: "shown-model" }), make("div", {}, "held-out error ", make("strong", { id: "shown-error" }, "–")),
    make("div", { id: "shown-about", className: "soft" }));
}

async function startWorkbench(main) {
  document.body.classList.add("workbench");
  const controls = make("aside", { id: "workbench-controls", "aria-label": "Model" });
  main.replaceChildren(controls, make("div", { id: "workbench-shown" },
    make("p", { id: "workbench-trouble", className: "warning", role: "alert", hidden: "" }),
    make("section", { id: "workbench-rungs", "aria-label": "Ladder of models", className: "scroll", tabindex: "0" }),
    make("div", { id: "workbench-picture" })));
  try {
    workbench.world = await ask("/api/begin");
  } catch (trouble) {
    showTrouble(trouble);
    return;
  }
  workbench.choice = workbench.world.begin;
  controls.append(statusBox(), lawChoice(), effectChoices(), formulaChoice(),
    make("fieldset", {}, make("legend", {}, "Parameters: starts and bounds"), make("ul", { id: "workbench-messages" }),
      make("div", { id: "workbench-parameters" })),
    selectionChoice(), diagnosisBox(), commandBox());
  fillControls();
  await show();
  followDiagnosis();
}

// The workbench: controls beside the report of the model they choose (include/tribofit/workbench/server.hpp). Every
// change asks the server for the picture of the new choice; answers that come late are dropped.

const bench = {
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
      headers: { "X-Workbench-Token": bench.token, ...(body ? { "Content-Type": "application/json" } : {}) },
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

function complain(trouble) {
  const box = document.getElementById("bench-trouble");
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
    `± ${number(rung.held_out_std_error, 2)}, RMSE on cycles that took no part in the fit (blocks held out in turn); ` +
    `${ratio ? `${number(ratio, 3)} floors, ` : ""}${rung.cycles}${rung.cycles < bench.world.cycles ? ` of ${bench.world.cycles}` : ""} cycles; ` +
    (rung.full ? "fitted as the command below does it" : "quick fit, being refined");
  document.getElementById("bench-command").textContent = rung.command;
}

function showRungs(rungs) {
  const worst = Math.max(...rungs.map((rung) => rung.held_out_rmse || 0), 1e-300);
  const best = Math.min(...rungs.map((rung) => (rung.held_out_rmse > 0 ? rung.held_out_rmse : Infinity)));
  const rows = rungs.map((rung) => {
    const bar = make("span", { className: "bar", "aria-hidden": "true" });
    bar.style.width = `${(100 * rung.held_out_rmse) / worst}%`;
    const current = bench.rung && rung.number === bench.rung.number;
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
  document.getElementById("bench-rungs").replaceChildren(make("table", {}, make("caption", {}, "Models visited"),
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
  clearTimeout(bench.settling);
  if (bench.asking) bench.asking.abort();
  const asking = new AbortController(), turn = ++bench.turn;
  bench.asking = asking;
  if (!full) bench.changedAt = performance.now();
  document.documentElement.dataset.bench = "asking";
  try {
    const answer = await ask("/api/show", { page: bench.page, turn, full, passing, choice: bench.choice }, asking.signal);
    if (answer.superseded || turn !== bench.turn) return;
    bench.rung = answer.rung;
    complain(null);
    showStatus(answer.rung);
    showRungs(answer.rungs);
    if (!full || !sameNames(answer.rung)) showParameters(answer.rung);
    else updateParameters(answer.rung);
    showReport(document.getElementById("bench-picture"), answer.report);
    if (!full) document.documentElement.dataset.answerMs = (performance.now() - bench.changedAt).toFixed(0);
    document.documentElement.dataset.bench = answer.rung.full ? "settled" : "shown";
    if (!answer.rung.full) bench.settling = setTimeout(() => show(true), 600);
  } catch (trouble) {
    if (trouble.name === "AbortError" || turn !== bench.turn) return;
    if (!trouble.problem) throw trouble;
    complain(trouble);
    document.documentElement.dataset.bench = "failed";
  }
}

let changing = 0;
/** After a change of the choice; a drag changes it many times a second. */
function changed(passing = false) {
  clearTimeout(changing);
  clearTimeout(bench.settling);
  changing = setTimeout(() => show(false, passing), 25);
}

function goTo(choice) {
  clearTimeout(changing); // a drag that was under way is of the choice before
  bench.choice = structuredClone(choice);
  fillControls();
  show();
}

// ---- controls ----

function field(label, input) {
  return make("label", { className: "field" }, make("span", {}, label), input);
}

function lawChoice() {
  return make("fieldset", {}, make("legend", {}, "Law"), ...bench.world.laws.map((law) => {
    const input = make("input", { type: "radio", name: "law", value: law, id: `law-${law}` });
    input.onchange = () => { bench.choice.law = law; changed(); };
    return make("label", { className: "tick" }, input, law);
  }));
}

function effectChoice(effect) {
  const input = make("input", { type: "checkbox", name: "effect", value: effect.name, id: `effect-${effect.name}` });
  input.disabled = effect.lacking !== "";
  input.onchange = () => {
    const others = bench.choice.effects.filter((name) => name !== effect.name);
    bench.choice.effects = input.checked ? [...others, effect.name] : others;
    changed();
  };
  return make("label", { className: "tick", title: `${effect.statement}. ${effect.equation}` }, input,
    make("span", {}, effect.name, make("small", {}, effect.lacking ? effect.lacking : effect.statement)));
}

function effectChoices() {
  const groups = new Map();
  for (const effect of bench.world.effects) groups.set(effect.group, [...(groups.get(effect.group) || []), effect]);
  const what = { friction: "What the contact does", rig: "What the machine does", measurement: "What the instruments do" };
  return make("fieldset", {}, make("legend", {}, "Effects"), ...[...groups].map(([group, effects], k) =>
    make("details", k === 0 && innerWidth > 800 ? { open: "" } : {}, make("summary", {}, what[group] || group), ...effects.map(effectChoice))));
}

function formulaChoice() {
  const text = make("textarea", { id: "bench-formula", rows: "3", spellcheck: "false", maxlength: "2000",
    placeholder: "hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s" });
  const apply = () => {
    bench.choice.formulas = text.value.split("\n").map((line) => line.trim()).filter((line) => line);
    changed();
  };
  text.onkeydown = (event) => { if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) apply(); };
  return make("fieldset", {}, make("legend", {}, "An effect of your own"),
    field("Formula: variables v [mm/s], acceleration, t [s], angle [rad], distance [mm], stick_time [s]; starts behind ;", text),
    make("button", { type: "button", id: "apply-formula", onclick: apply }, "Apply formula"));
}

function numberField(label, id, value, onchange, step = "any") {
  const input = make("input", { type: "number", id, step, value: value === null ? "" : String(value) });
  input.onchange = () => onchange(input.value === "" ? null : Number(input.value));
  return field(label, input);
}

function selectionChoice() {
  const box = make("fieldset", { id: "bench-selection" });
  const fill = () => {
    const last = bench.world.cycles - 1, [from, to] = bench.choice.cycles || [0, last];
    const setCycles = (first, final) => {
      const a = Math.max(0, Math.min(first ?? 0, last)), b = Math.max(a, Math.min(final ?? last, last));
      bench.choice.cycles = a === 0 && b === last ? null : [a, b];
      fill();
      changed();
    };
    const excluded = bench.choice.excluded.map(([a, b], k) => make("li", {}, `${number(a, 5)} s to ${number(b, 5)} s `,
      make("button", { type: "button", "aria-label": `Take part again: ${a} s to ${b} s`, onclick: () => {
        bench.choice.excluded.splice(k, 1);
        fill();
        changed();
      } }, "Take back")));
    const a = make("input", { type: "number", step: "any", min: "0", id: "exclude-from", "aria-label": "Leave out from [s]" });
    const b = make("input", { type: "number", step: "any", min: "0", id: "exclude-to", "aria-label": "Leave out to [s]" });
    const add = () => {
      const stretch = [Number(a.value), Number(b.value)];
      if (a.value === "" || b.value === "" || !(stretch[0] < stretch[1])) {
        complain({ problem: "Nothing is left out", why: "a stretch runs from an earlier to a later time in seconds", suggestion: "" });
        return;
      }
      bench.choice.excluded.push(stretch);
      fill();
      changed();
    };
    const cycles = bench.world.sticks ? [make("div", { className: "row" },
      numberField("Cycles from", "cycles-from", from, (value) => setCycles(value, to), "1"),
      numberField(`to (of 0 to ${last})`, "cycles-to", to, (value) => setCycles(from, value), "1"))] : [];
    box.replaceChildren(make("legend", {}, "Part of the record"), ...cycles,
      make("div", { className: "row" }, field("Leave out from [s]", a), field("to [s]", b),
        make("button", { type: "button", id: "exclude", onclick: add }, "Leave out")),
      make("ul", { id: "excluded" }, ...excluded));
  };
  box.fill = fill;
  fill();
  return box;
}

/** Places from 0 to 1 on a slider over the plausible range of a parameter, by decades where its ends are far apart. */
function scaleOf(p) {
  if (!bench.choice.bounds[p.full_name] || !bench.plausible.has(p.full_name)) bench.plausible.set(p.full_name, p.bounds);
  const [low, high] = bench.plausible.get(p.full_name), decades = low > 0 && high > 100 * low;
  const place = (value) => (decades ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
  const valueAt = (part) => {
    if (part <= 0) return low;
    if (part >= 1) return high;
    return Number((decades ? low * Math.pow(high / low, part) : low + part * (high - low)).toPrecision(4));
  };
  return { place, valueAt, fixed: !(low < high) };
}

/** A slider and a number for one of start, lower and upper bound. get() may be null: shown is `otherwise`. */
function valueControl(p, scale, { label, id, get, otherwise, set }) {
  const what = `${label} of ${p.full_name}${p.unit === "1" ? "" : ` [${p.unit}]`}`;
  const exact = (value) => String(Number(value.toPrecision(12)));
  const slider = make("input", { type: "range", min: "0", max: "1", step: "0.001", id: `slide-${id}`, "aria-label": what,
    value: String(scale.place(get() ?? otherwise) || 0) });
  slider.disabled = scale.fixed;
  const text = make("input", { type: "number", step: "any", id: `${id}`, "aria-label": what,
    value: get() === null ? "" : exact(get()), placeholder: Number(otherwise.toPrecision(4)) });
  slider.oninput = () => {
    const value = scale.valueAt(Number(slider.value));
    slider.setAttribute("aria-valuetext", `${value} ${p.unit}`);
    text.value = exact(set(value));
    changed(true);
  };
  text.onchange = () => {
    set(text.value === "" ? null : Number(text.value));
    changed();
  };
  return make("div", { className: "value" }, make("span", {}, label), slider, text);
}

/** Start and bounds of a parameter. */
function parameterControl(p) {
  const name = p.full_name, scale = scaleOf(p), { start, bounds } = bench.choice;
  const bound = (which, label, id) => valueControl(p, scale, { label, id: `${id}-${name}`, otherwise: p.bounds[which],
    get: () => (bounds[name] ? bounds[name][which] : null),
    set: (value) => {
      const ends = [...(bounds[name] || p.bounds)];
      ends[which] = value === null ? bench.plausible.get(name)[which] : value;
      if (which === 0) ends[0] = Math.min(ends[0], ends[1]);
      else ends[1] = Math.max(ends[0], ends[1]);
      bounds[name] = ends;
      if (start[name] !== undefined) start[name] = Math.min(Math.max(start[name], ends[0]), ends[1]);
      return ends[which];
    } });
  const reset = make("button", { type: "button", "aria-label": `Start and bounds of ${name} from the data`, onclick: () => {
    delete start[name];
    delete bounds[name];
    changed();
  } }, "From the data");
  return make("details", { className: "parameter", "data-name": name, ...(bench.unfolded.has(name) ? { open: "" } : {}),
    ontoggle: (event) => (event.target.open ? bench.unfolded.add(name) : bench.unfolded.delete(name)) },
  make("summary", {}, make("strong", {}, name), " = ", make("span", { "data-value": name }, parameterText(p))),
  valueControl(p, scale, { label: "start", id: `start-${name}`, otherwise: p.start, get: () => start[name] ?? null,
    set: (value) => {
      if (value === null) delete start[name];
      else start[name] = bounds[name] ? Math.min(Math.max(value, bounds[name][0]), bounds[name][1]) : value;
      return start[name] ?? null;
    } }),
  bound(0, "from", "lower"), bound(1, "to", "upper"), reset);
}

function parameterText(p) {
  const error = p.std_error > 0 ? ` ± ${number(p.std_error, 2)}` : "";
  const flag = !p.determined ? ", not determined" : p.at_bound ? ", at its bound" : "";
  return `${number(p.value, 5)}${error}${p.unit === "1" ? "" : ` ${p.unit}`}${flag}`;
}

const sameNames = (rung) => rung.parameters.map((p) => p.full_name).join() ===
  [...document.querySelectorAll("#bench-parameters .parameter")].map((element) => element.dataset.name).join();

/** New numbers beside controls that may be in use. */
function updateParameters(rung) {
  for (const p of rung.parameters) {
    const touched = bench.choice.start[p.full_name] !== undefined || bench.choice.bounds[p.full_name] !== undefined;
    document.querySelector(`.parameter[data-name="${CSS.escape(p.full_name)}"] button`).disabled = !touched;
    document.querySelector(`[data-value="${CSS.escape(p.full_name)}"]`).textContent = parameterText(p);
  }
  document.getElementById("bench-messages").replaceChildren(...rung.messages.map((text) => make("li", {}, prose(text))));
}

function showParameters(rung) {
  const box = document.getElementById("bench-parameters");
  const inUse = box.contains(document.activeElement) && document.activeElement.type === "range";
  if (!inUse || !sameNames(rung)) {
    const id = box.contains(document.activeElement) ? document.activeElement.id : "";
    box.replaceChildren(...rung.parameters.map(parameterControl));
    if (id && document.getElementById(id)) document.getElementById(id).focus();
  }
  updateParameters(rung);
}

/** The controls as the choice is. */
function fillControls() {
  const { law, effects, formulas } = bench.choice;
  for (const input of document.querySelectorAll("input[name=law]")) input.checked = input.value === law;
  for (const input of document.querySelectorAll("input[name=effect]")) {
    input.checked = effects.includes(input.value);
    if (input.checked) input.closest("details").open = true;
  }
  document.getElementById("bench-formula").value = formulas.join("\n");
  document.getElementById("bench-selection").fill();
}

// ---- diagnosis and session ----

function diagnosisBox() {
  return make("fieldset", {}, make("legend", {}, "Diagnosis"),
    make("p", { className: "soft" }, "Tries every effect of the catalogue and your formulas on blocks of cycles that are held out."),
    make("div", { className: "row" },
      make("button", { type: "button", id: "bench-diagnose", onclick: beginDiagnosis }, "Diagnose"),
      make("button", { type: "button", id: "bench-cancel", disabled: "", onclick: () => ask("/api/cancel", {}).catch(complain) }, "Cancel")),
    make("progress", { id: "bench-progress", max: "1", value: "0", hidden: "", "aria-label": "Progress of the diagnosis" }),
    make("p", { id: "bench-doing", role: "status" }), make("div", { id: "bench-finding" }));
}

async function beginDiagnosis() {
  try {
    await ask("/api/diagnose", { choice: bench.choice });
    followDiagnosis();
  } catch (trouble) {
    complain(trouble);
  }
}

async function followDiagnosis() {
  clearTimeout(bench.polling);
  let state;
  try {
    state = await ask("/api/diagnosis");
  } catch (trouble) {
    complain(trouble);
    return;
  }
  const running = state.state === "running";
  document.getElementById("bench-diagnose").disabled = running;
  document.getElementById("bench-cancel").disabled = !running;
  const progress = document.getElementById("bench-progress");
  progress.hidden = !running;
  progress.value = state.part;
  document.getElementById("bench-doing").textContent = running ? prose(state.doing) : prose(state.sentence || "");
  document.documentElement.dataset.diagnosis = state.state;
  if (running) bench.polling = setTimeout(followDiagnosis, 300);
  else showFinding(state);
}

function showFinding(state) {
  const box = document.getElementById("bench-finding");
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
    make("a", { href: url, download: `${bench.world.trace.path.split("/").pop().replace(/\.[^.]*$/, "")}-session.json` }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  } catch (trouble) {
    complain(trouble);
  }
}

function commandBox() {
  const copy = async (event) => {
    try {
      await navigator.clipboard.writeText(document.getElementById("bench-command").textContent);
      event.target.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(document.getElementById("bench-command"));
    }
  };
  return make("fieldset", {}, make("legend", {}, "The same from the command line"), make("pre", { id: "bench-command" }),
    make("div", { className: "row" }, make("button", { type: "button", onclick: copy }, "Copy"),
      make("button", { type: "button", id: "bench-save", onclick: saveSession }, "Save session")));
}

// ---- the page ----

function statusBox() {
  return make("div", { id: "bench-status", role: "status", "aria-live": "polite" },
    make("div", { id: "shown-model" }), make("div", {}, "held-out error ", make("strong", { id: "shown-error" }, "–")),
    make("div", { id: "shown-about", className: "soft" }));
}

async function startWorkbench(main) {
  document.body.classList.add("workbench");
  const controls = make("aside", { id: "bench-controls", "aria-label": "Model" });
  main.replaceChildren(controls, make("div", { id: "bench-shown" },
    make("p", { id: "bench-trouble", className: "warning", role: "alert", hidden: "" }),
    make("section", { id: "bench-rungs", "aria-label": "Ladder of models", className: "scroll", tabindex: "0" }),
    make("div", { id: "bench-picture" })));
  try {
    bench.world = await ask("/api/begin");
  } catch (trouble) {
    complain(trouble);
    return;
  }
  bench.choice = bench.world.begin;
  controls.append(statusBox(), lawChoice(), effectChoices(), formulaChoice(),
    make("fieldset", {}, make("legend", {}, "Parameters: starts and bounds"), make("ul", { id: "bench-messages" }), make("div", { id: "bench-parameters" })),
    selectionChoice(), diagnosisBox(), commandBox());
  fillControls();
  await show();
  followDiagnosis();
}

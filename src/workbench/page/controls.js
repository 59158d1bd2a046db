// The controls of the workbench: law, effects, formula, parameters, part of the record. Each changes workbench.choice and says
// changed() (workbench.js).

function field(label, input) {
  return make("label", { className: "field" }, make("span", {}, label), input);
}

function lawChoice() {
  return make("fieldset", { className: "laws" }, make("legend", {}, "Law"), ...workbench.world.laws.map((law) => {
    const input = make("input", { type: "radio", name: "law", value: law, id: `law-${law}` });
    input.onchange = () => { workbench.choice.law = law; changed(); };
    return make("label", { className: "tick" }, input, law);
  }));
}

function effectChoice(effect) {
  const input = make("input", { type: "checkbox", name: "effect", value: effect.name, id: `effect-${effect.name}` });
  input.disabled = effect.lacking !== "";
  input.onchange = () => {
    const others = workbench.choice.effects.filter((name) => name !== effect.name);
    workbench.choice.effects = input.checked ? [...others, effect.name] : others;
    changed();
  };
  return make("label", { className: "tick", title: `${effect.statement}. ${effect.equation}` }, input,
    make("span", {}, effect.name, make("small", {}, effect.lacking ? effect.lacking : effect.statement)));
}

function effectChoices() {
  const groups = new Map();
  for (const effect of workbench.world.effects) groups.set(effect.group, [...(groups.get(effect.group) || []), effect]);
  const what = { friction: "What the contact does", rig: "What the machine does", measurement: "What the instruments do" };
  return make("fieldset", {}, make("legend", {}, "Effects"), ...[...groups].map(([group, effects], k) =>
    make("details", k === 0 ? { open: "" } : {}, make("summary", {}, what[group] || group), ...effects.map(effectChoice))));
}

function formulaChoice() {
  const text = make("textarea", { id: "workbench-formula", rows: "3", spellcheck: "false", maxlength: "2000",
    placeholder: "hump = a*exp(-((v-v0)/w)^2); a=0.02, v0=25mm/s, w=6mm/s" });
  const apply = () => {
    workbench.choice.formulas = text.value.split("\n").map((line) => line.trim()).filter((line) => line);
    workbench.formulaPending = true;
    changed();
  };
  text.onkeydown = (event) => { if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) apply(); };
  return make("fieldset", {}, make("legend", { className: "visually-hidden" }, "An effect of your own"),
    field("Formula: variables v [mm/s], acceleration, t [s], angle [rad], distance [mm], stick_time [s]; after a semicolon the start values", text),
    make("p", { id: "formula-trouble", className: "warning", role: "alert", hidden: "" }),
    make("button", { type: "button", id: "apply-formula", onclick: apply }, "Apply formula"));
}

function numberField(label, id, value, onchange, step = "any") {
  const input = make("input", { type: "number", id, step, value: value === null ? "" : String(value) });
  input.onchange = () => onchange(input.value === "" ? null : Number(input.value));
  return field(label, input);
}

function selectionChoice() {
  const box = make("fieldset", { id: "workbench-selection" });
  const fill = () => {
    const last = workbench.world.cycles - 1, [from, to] = workbench.choice.cycles || [0, last];
    const setCycles = (first, final) => {
      const a = Math.max(0, Math.min(first ?? 0, last)), b = Math.max(a, Math.min(final ?? last, last));
      workbench.choice.cycles = a === 0 && b === last ? null : [a, b];
      fill();
      changed();
    };
    const excluded = workbench.choice.excluded.map(([a, b], k) => make("li", {}, `${number(a, 5)} s to ${number(b, 5)} s `,
      make("button", { type: "button", "aria-label": `Take part again: ${a} s to ${b} s`, onclick: () => {
        workbench.choice.excluded.splice(k, 1);
        fill();
        changed();
      } }, "Take back")));
    const a = make("input", { type: "number", step: "any", min: "0", id: "exclude-from", "aria-label": "Leave out from [s]" });
    const b = make("input", { type: "number", step: "any", min: "0", id: "exclude-to", "aria-label": "Leave out to [s]" });
    const add = () => {
      const stretch = [Number(a.value), Number(b.value)];
      if (a.value === "" || b.value === "" || !(stretch[0] < stretch[1])) {
        showTrouble({ problem: "Nothing is left out", why: "a stretch runs from an earlier to a later time in seconds", suggestion: "" });
        return;
      }
      workbench.choice.excluded.push(stretch);
      fill();
      changed();
    };
    const cycles = workbench.world.sticks ? [make("div", { className: "row" },
      numberField("Cycles from", "cycles-from", from, (value) => setCycles(value, to), "1"),
      numberField(`to (of 0 to ${last})`, "cycles-to", to, (value) => setCycles(from, value), "1"))] : [];
    box.replaceChildren(make("legend", { className: "visually-hidden" }, "Part of the record"), ...cycles,
      make("div", { className: "row" }, field("Leave out from [s]", a), field("to [s]", b),
        make("button", { type: "button", id: "exclude", onclick: add }, "Leave out")),
      make("ul", { id: "excluded" }, ...excluded));
  };
  box.fill = fill;
  fill();
  return box;
}

/** Radius, speed and load of the record, as the command line takes them; with others the record is read anew. */
function conditionsChoice() {
  const { conditions } = workbench.world;
  if (conditions.steps) return make("p", {}, "The record has steps with conditions of their own, which the command line states.");
  const known = (value, unit) => (value === null || value === undefined ? "" : `${Number(value.toPrecision(6))} ${unit}`);
  const values = { radius: known(conditions.radius_mm, "mm"), speed: known(conditions.speed_rpm, "rpm"), load: known(conditions.load_N, "N") };
  // What the record itself says stands in grey: left empty, it is found there again.
  const inputs = Object.entries(values).map(([name, value]) => {
    const stated = (conditions[`${name}_source`] || "").includes("command line");
    return [name, make("input", { type: "text", id: `condition-${name}`, size: "10", maxlength: "60", spellcheck: "false",
      value: stated ? value : "", placeholder: value || "not known" })];
  });
  const apply = async () => {
    const given = Object.fromEntries(inputs.map(([name, input]) => [name, input.value.trim()]));
    try {
      await ask("/api/conditions", given);
      // The model in view goes along, where it can be fitted under these conditions.
      await ask("/api/show", { page: workbench.page, turn: ++workbench.turn, choice: workbench.choice })
        .catch(() => history.replaceState(null, ""));
      location.reload();
    } catch (trouble) {
      showTrouble(trouble);
    }
  };
  return make("fieldset", { id: "workbench-conditions" }, make("legend", { className: "visually-hidden" }, "Conditions"),
    make("div", { className: "row" }, ...inputs.map(([name, input]) => field(name[0].toUpperCase() + name.slice(1), input))),
    make("button", { type: "button", id: "apply-conditions", onclick: apply }, "Read the record with these"));
}

/** Places from 0 to 1 on a slider over the plausible range of a parameter, by decades where its ends are far apart. */
function scaleOf(p) {
  if (!workbench.choice.bounds[p.full_name] || !workbench.plausible.has(p.full_name)) workbench.plausible.set(p.full_name, p.bounds);
  const [low, high] = workbench.plausible.get(p.full_name), decades = low > 0 && high > 100 * low;
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
    drawByHand({ [p.full_name]: value });
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
  const name = p.full_name, scale = scaleOf(p), { start, bounds } = workbench.choice;
  const bound = (which, label, id) => valueControl(p, scale, { label, id: `${id}-${name}`, otherwise: p.bounds[which],
    get: () => (bounds[name] ? bounds[name][which] : null),
    set: (value) => {
      const ends = [...(bounds[name] || p.bounds)];
      ends[which] = value === null ? workbench.plausible.get(name)[which] : value;
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
  return make("details", { className: "parameter", "data-name": name, ...(workbench.unfolded.has(name) ? { open: "" } : {}),
    ontoggle: (event) => (event.target.open ? workbench.unfolded.add(name) : workbench.unfolded.delete(name)) },
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
  [...document.querySelectorAll("#workbench-parameters .parameter")].map((element) => element.dataset.name).join();

/** New numbers beside controls that may be in use. */
function updateParameters(rung) {
  for (const p of rung.parameters) {
    const touched = workbench.choice.start[p.full_name] !== undefined || workbench.choice.bounds[p.full_name] !== undefined;
    document.querySelector(`.parameter[data-name="${CSS.escape(p.full_name)}"] button`).disabled = !touched;
    document.querySelector(`[data-value="${CSS.escape(p.full_name)}"]`).textContent = parameterText(p);
  }
  document.getElementById("workbench-messages").replaceChildren(...rung.messages.map((text) => make("li", {}, prose(text))));
}

function showParameters(rung) {
  const box = document.getElementById("workbench-parameters");
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
  const { law, effects, formulas } = workbench.choice;
  for (const input of document.querySelectorAll("input[name=law]")) input.checked = input.value === law;
  for (const input of document.querySelectorAll("input[name=effect]")) {
    input.checked = effects.includes(input.value);
    if (input.checked) input.closest("details").open = true;
  }
  document.getElementById("workbench-formula").value = formulas.join("\n");
  document.getElementById("workbench-selection").fill();
}

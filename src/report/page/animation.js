// A block on its disc in motion, drawn as it is seen from the side: the spring holds it, the disc runs under it. What was
// measured and what was simulated move side by side, on the same scale and by the same clock.

const slowness = [["10 times as fast", 10], ["as it is", 1], ["half as fast", 0.5], ["5 times slower", 0.2],
  ["10 times slower", 0.1], ["20 times slower", 0.05], ["50 times slower", 0.02], ["100 times slower", 0.01],
  ["500 times slower", 0.002]];

const scene = { width: 420, height: 242, wall: 14, rest: 170, block: 64, deck: 96, reach: 150, plotTop: 138,
  plotBottom: 212, plotLeft: 44, plotRight: 410 };

/** Where the block is at a time of its loop, and whether it sticks. */
function blockAt(block, t) {
  const { time, displacement, sticks } = block;
  const k = Math.max(0, time.findLastIndex((at) => at <= t)), next = Math.min(k + 1, time.length - 1);
  const step = time[next] - time[k], part = step > 0 ? (t - time[k]) / step : 0;
  return { displacement: displacement[k] + part * (displacement[next] - displacement[k]), sticks: sticks[k] };
}

function springPath(from, to, y) {
  const turns = 9, lead = 8, pitch = (to - from - 2 * lead) / turns;
  let path = `M${from},${y}h${lead}`;
  for (let k = 0; k < turns; ++k) path += `l${pitch / 4},-9l${pitch / 2},18l${pitch / 4},-9`;
  return path + `H${to}`;
}

/** One block: {element, show(t)}. scale: pixels a millimetre, the same for all blocks beside each other. */
function blockScene(block, animation, bounds) {
  const s = scene, loop = block.time[block.time.length - 1] || 1;
  const scale = s.reach / Math.max(bounds.high - bounds.low, 1e-12);
  const toX = (t) => s.plotLeft + (t / loop) * (s.plotRight - s.plotLeft);
  const toY = (x) => s.plotBottom - ((x - bounds.low) / Math.max(bounds.high - bounds.low, 1e-12)) *
    (s.plotBottom - s.plotTop);
  const spring = svgPart("path", { fill: "none", stroke: styles.colours.black, "stroke-width": 1.6 });
  const body = svgPart("rect", { y: s.deck - 34, width: s.block, height: 34, stroke: styles.colours.black, "stroke-width": 1.6 });
  const word = svgPart("text", { y: s.deck - 13, "text-anchor": "middle", "font-size": 13, fill: styles.text });
  const marks = svgPart("path", { stroke: styles.colours.black, "stroke-width": 1.4 });
  const dot = svgPart("circle", { r: 4.5, fill: styles.colours.red, stroke: styles.paper });
  const label = (x, y, text, anchor = "start", more = {}) =>
    svgPart("text", { x, y, "text-anchor": anchor, "font-size": 12, fill: styles.text, ...more }, text);
  const low = number(bounds.low, 3), high = number(bounds.high, 3);
  const points = block.time.map((t, k) => `${toX(t).toFixed(1)},${toY(block.displacement[k]).toFixed(1)}`);
  const element = svgPart("svg", { viewBox: `0 0 ${s.width} ${s.height}`, role: "img",
    "aria-label": `${block.name}: block on its disc, displacement from ${low} to ${high} mm` },
  label(s.wall, 20, block.name, "start", { "font-size": 14, "font-weight": 600 }),
  svgPart("path", { d: `M${s.wall},40V${s.deck}`, stroke: styles.colours.black, "stroke-width": 4 }), spring, body, word,
  svgPart("rect", { x: 0, y: s.deck, width: s.width, height: 14, fill: styles.disc, stroke: styles.colours.black }), marks,
  label(s.width - 4, s.deck + 28, `disc ${number(animation.disc_velocity, 3)} mm/s \u2192`, "end"),
  svgPart("path", { d: `M${points.join("L")}`, fill: "none", stroke: styles.colours.blue, "stroke-width": 1.4 }),
  svgPart("path", { d: `M${s.plotLeft},${s.plotTop - 4}V${s.plotBottom}H${s.plotRight}`, fill: "none", stroke: styles.axis }),
  label(s.plotLeft - 4, s.plotTop + 6, high, "end"), label(s.plotLeft - 4, s.plotBottom, low, "end"),
  label(s.plotLeft - 4, (s.plotTop + s.plotBottom) / 2 + 4, "mm", "end"),
  label(s.plotLeft, s.plotTop - 8, "displacement of the block"), label(s.plotLeft, s.plotBottom + 16, "0 s"),
  label(s.plotRight, s.plotBottom + 16, `${number(loop, 3)} s`, "end"), dot);
  const show = (time) => {
    const t = time % loop, now = blockAt(block, t);
    const left = s.rest + (now.displacement - bounds.low) * scale - s.block / 2;
    spring.setAttribute("d", springPath(s.wall, left, s.deck - 17));
    body.setAttribute("x", left);
    body.setAttribute("fill", now.sticks ? styles.sticking : styles.slipping);
    word.setAttribute("x", left + s.block / 2);
    word.textContent = now.sticks ? "sticks" : "slips";
    const pitch = 42, shift = (time * animation.disc_velocity * scale) % pitch;
    let path = "";
    for (let x = shift - pitch; x < s.width; x += pitch) if (x > 0) path += `M${x.toFixed(1)},${s.deck}v14`;
    marks.setAttribute("d", path);
    dot.setAttribute("cx", toX(t));
    dot.setAttribute("cy", toY(now.displacement));
    return { t, ...now };
  };
  return { element, show, loop };
}

/** The factor by which a loop takes about four seconds. */
function usualSpeed(loop) {
  const off = (factor) => Math.abs(Math.log(loop / factor / 4));
  return slowness.map(([, factor]) => factor).reduce((best, factor) => (off(factor) < off(best) ? factor : best));
}

/** Moves every block to a time; returns what they do there, in words. */
function showBlocks(scenes, blocks, at) {
  return scenes.map((one, k) => {
    const now = one.show(at), name = blocks.length > 1 ? `${blocks[k].name}: ` : "";
    return `${name}${now.displacement.toFixed(3)} mm, ${now.sticks ? "sticks" : "slips"}`;
  }).join("; ");
}

/** An animation: blocks side by side, play and pause, a slider of the time, the speed. */
function animationFigure(animation) {
  const blocks = animation.blocks.filter((block) => block.time.length > 1);
  if (!blocks.length) return make("div");
  const all = blocks.flatMap((block) => block.displacement);
  const bounds = { low: all.reduce((a, b) => Math.min(a, b)), high: all.reduce((a, b) => Math.max(a, b)) };
  const scenes = blocks.map((block) => blockScene(block, animation, bounds));
  const loop = Math.max(...scenes.map((one) => one.loop));
  let time = 0, playing = false, before = null, seen = true, speed = usualSpeed(loop);

  const button = make("button", { type: "button", "aria-pressed": "false", onclick: () => play(!playing) }, "Play");
  const slider = make("input", { type: "range", min: "0", max: "1000", value: "0", "aria-label": "time of the loop",
    oninput: () => { play(false); show((slider.value / 1000) * loop); } });
  const select = make("select", { onchange: () => { speed = Number(select.value); } },
    ...slowness.map(([name, factor]) => make("option", { value: String(factor) }, name)));
  select.value = String(speed);
  const shown = make("output", {});
  const row = make("div", { className: "blocks" });
  scenes.forEach((one) => row.append(one.element));
  const figure = make("figure", { className: "animation", id: animation.id },
    make("figcaption", {}, make("h3", {}, animation.title), animation.note ? make("p", {}, animation.note) : null), row,
    make("div", { className: "tools" }, button, make("label", {}, "speed ", select), make("label", {}, "time ", slider),
      shown));

  function show(at) {
    time = at;
    const words = showBlocks(scenes, blocks, at);
    slider.value = String(Math.round(((at % loop) / loop) * 1000));
    shown.textContent = `${(at % loop).toFixed(4)} s; ${words}`;
  }

  function step(now) {
    if (!playing || !seen) return;
    if (before !== null) show(time + Math.min(now - before, 200) / 1000 * speed);
    before = now;
    requestAnimationFrame(step);
  }

  function play(on) {
    if (on === playing) return;
    playing = on;
    before = null;
    button.textContent = on ? "Pause" : "Play";
    button.setAttribute("aria-pressed", String(on));
    if (on) requestAnimationFrame(step);
  }

  new IntersectionObserver((entries) => { // what is out of view need not move
    const was = seen;
    seen = entries[entries.length - 1].isIntersecting;
    before = null;
    if (playing && seen && !was) requestAnimationFrame(step);
  }).observe(figure);
  show(0);
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
  addEventListener("beforeprint", () => play(false));
  return figure;
}

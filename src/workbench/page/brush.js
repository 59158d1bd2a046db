// Stretches of time that a hand leaves out, on the charts over the time of the record.

/** On charts over the time of the record a stretch can be marked and left out. */
function addBrushes(box) {
  for (const item of chartItems.values()) {
    const overRecord = item.chart.x.quantity === "time" && item.chart.x.unit === "s";
    if (!overRecord || !box.contains(item.figure) || item.brush) continue;
    item.brush = make("button", { type: "button", "aria-pressed": "false", className: "brush", title: "Drag over the chart to leave a stretch of time out",
      onclick: () => setBrush(item, item.brush.getAttribute("aria-pressed") !== "true") }, "Leave out a stretch");
    item.tools.prepend(item.brush);
  }
}

function setBrush(item, on) {
  bringUpToDate(item);
  item.brush.setAttribute("aria-pressed", String(on));
  item.brush.textContent = on ? "Drag over the chart …" : "Leave out a stretch";
  item.drag = on ? { dragmode: "select", selectdirection: "h" } : {}; // also where the chart is drawn anew meanwhile
  Plotly.relayout(item.plot, { dragmode: layoutOf(item.chart).dragmode ?? "zoom", ...item.drag, selections: [] });
  item.plot.removeAllListeners("plotly_selected");
  if (!on) return;
  item.plot.on("plotly_selected", (event) => {
    if (!event || !event.range) return; // drawn anew
    const range = Object.entries(event.range).find(([name]) => name.startsWith("x"));
    setBrush(item, false);
    if (range) leaveOut(range[1].map((t) => Number(t.toPrecision(6))).sort((a, b) => a - b));
  });
}

function leaveOut(stretch) {
  if (!(stretch[0] < stretch[1])) return;
  workbench.choice.excluded.push([Math.max(0, stretch[0]), stretch[1]]);
  document.getElementById("workbench-selection").fill();
  changed();
}

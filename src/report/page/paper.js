// Charts on paper: saved as pictures, and printed with the page.

/** Saves the chart with title and legend, wide enough for print. */
function savePicture(item, format) {
  bringUpToDate(item);
  const height = Math.max(560, item.chart.height);
  const layout = { ...layoutOf(item.chart), showlegend: true, width: 900, height,
    title: { text: plain(item.chart.title), x: 0.5 }, margin: { l: 70, r: 20, t: 60, b: 110 },
    legend: { orientation: "h", y: -0.18, yanchor: "top" } };
  for (const name of axesOf(item.chart)) layout[name].range = [...item.plot._fullLayout[name].range];
  fitBelow(layout, item.chart, layout.width);
  return Plotly.toImage({ data: item.traces, layout }, { format, width: 900, height, scale: format === "png" ? 3 : 1 })
    .then((url) => save(`${item.chart.id}.${format}`, url));
}

// On paper charts are as wide as the page, and folded tables are open.
let unfolded = [];
const drawnItems = () => [...chartItems.values()].filter((item) => item.plot.isConnected);

/** Draws a chart anew, as wide as given or as its place. */
function redraw(item, width) {
  prepare(item, width ? { width, autosize: false } : { autosize: true });
  draw(item);
}

addEventListener("beforeprint", () => {
  unfolded = [...document.querySelectorAll("details:not(.numbers):not([open])")];
  for (const details of unfolded) details.open = true;
  drawnItems().forEach((item) => redraw(item, 640));
});
addEventListener("afterprint", () => {
  for (const details of unfolded) details.open = false;
  drawnItems().forEach((item) => redraw(item, null));
});

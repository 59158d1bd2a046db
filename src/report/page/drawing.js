// When charts are drawn: words come first, then the charts in view, then the rest, a few at a time. A page that changes under
// the hand shows words and charts in view together, in one frame; those farther than a screen wait until they come near.

let waiting = []; // charts not drawn yet, or not as they are now
let isDrawing = false;
let changesUnderHand = false;

/** Draws a chart as it is described now. */
function draw(item) {
  waiting = waiting.filter((other) => other !== item);
  fitBelow(item.layout, item.chart, item.layout.width || item.plot.clientWidth);
  Plotly.react(item.plot, item.traces, item.layout, { responsive: true, displaylogo: false, displayModeBar: false,
    doubleClick: "reset", scrollZoom: false });
  item.shown = item.described;
}

/** Draws a chart that waits for it: before something is done with it. */
function bringUpToDate(item) {
  if (waiting.includes(item)) draw(item);
}

/** Has a chart drawn in its turn. */
function drawSoon(item) {
  if (!waiting.includes(item)) waiting.push(item);
  beginDrawing();
}

function beginDrawing() {
  if (isDrawing) return;
  isDrawing = true;
  delete document.documentElement.dataset.drawn;
  if (changesUnderHand) queueMicrotask(drawWaiting); // when the change that asks for it is made
  else requestAnimationFrame(() => setTimeout(drawWaiting, 0));
}

/** Whether a chart is in view, or so many pixels above or below. */
function isWithin(item, margin) {
  const box = item.plot.getBoundingClientRect();
  return item.plot.isConnected && box.bottom > -margin && box.top < innerHeight + margin;
}

const inView = () => waiting.filter((item) => isWithin(item, 0));
const due = () => waiting.filter((item) => isWithin(item, changesUnderHand ? innerHeight : Infinity));

function drawWaiting() {
  const first = inView(), few = 3;
  try {
    (first.length > 0 ? first : due().slice(0, few)).forEach(draw);
  } finally {
    isDrawing = due().length > 0;
    if (isDrawing) setTimeout(drawWaiting, 0);
    else document.documentElement.dataset.drawn = "all";
  }
}

/** A screen ahead: who scrolls finds the chart drawn. */
const comingNear = new IntersectionObserver(() => {
  if (due().length > 0) beginDrawing();
}, { rootMargin: "100% 0px" });

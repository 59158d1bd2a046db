// When charts are drawn. A report shows its words first, then what is in view, then the rest, a few charts at a time. A page
// that changes under the hand shows words and charts in view together, in one frame, and leaves charts far from view until
// they come near: each costs as much as all of its words.

let waiting = []; // charts not drawn yet, or not as they are now
let isDrawing = false;
let changesUnderHand = false; // whether this page does

const drawingTime = 50; // ms: a page that answers later than that feels slow

/** Draws a chart as it is described now. */
function draw(item) {
  waiting = waiting.filter((other) => other !== item);
  fitBelow(item.layout, item.chart, item.layout.width || item.plot.clientWidth);
  Plotly.react(item.plot, item.traces, item.layout, { responsive: true, displaylogo: false, displayModeBar: false,
    doubleClick: "reset", scrollZoom: false });
  item.shown = item.described;
}

/** Draws a chart that is not as it is described: before something is done with it. */
function bringUpToDate(item) {
  if (item.shown !== item.described) draw(item);
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
  return box.bottom > -margin && box.top < innerHeight + margin;
}

/** Charts to draw, in their order: those in view, then those near, or of a page that draws all. */
function chartsDue() {
  waiting = waiting.filter((item) => item.plot.isConnected);
  const inView = waiting.filter((item) => isWithin(item, 0));
  return [...inView, ...waiting.filter((item) => !inView.includes(item) && (!changesUnderHand || isWithin(item, innerHeight)))];
}

/** Draws what is due. Of what is not in view a few charts at a time, so that the page stays alive: one by one it would be
 * laid out and painted as often. */
function drawWaiting() {
  const due = chartsDue(), began = performance.now();
  const atOnce = changesUnderHand ? due.filter((item) => isWithin(item, 0)).length : 1;
  let drawn = 0;
  while (drawn < due.length && (drawn < atOnce || performance.now() - began < drawingTime)) draw(due[drawn++]);
  if (drawn < due.length) {
    setTimeout(drawWaiting, 0);
  } else {
    isDrawing = false;
    document.documentElement.dataset.drawn = "all";
  }
}

/** A screen ahead: who scrolls finds the chart drawn. */
const comingNear = new IntersectionObserver((entries) => {
  if (entries.some((entry) => entry.isIntersecting) && chartsDue().length > 0) beginDrawing();
}, { rootMargin: "100% 0px" });

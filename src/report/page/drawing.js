// When charts are drawn: after the words, what is in view first, a few at a time.

let waiting = []; // charts not drawn yet, or not as they are now
let isDrawing = false;
/** Whether charts that nobody has come near yet are drawn as well. A page that changes under the hand leaves them: each costs
 * as much as all of its words. */
let drawsFarCharts = true;

const drawingTime = 50; // ms: a page that answers later than that feels slow

/** Draws a chart as it is described now. */
function draw(item) {
  waiting = waiting.filter((other) => other !== item);
  fitBelow(item.layout, item.chart, item.layout.width || item.plot.clientWidth);
  Plotly.react(item.plot, item.traces, item.layout, { responsive: true, displaylogo: false, displayModeBar: false,
    doubleClick: "reset", scrollZoom: false });
  item.drawn = true;
  item.shown = item.described;
}

/** Has a chart drawn once the words are on the screen. */
function drawSoon(item) {
  if (!waiting.includes(item)) waiting.push(item);
  beginDrawing();
}

function beginDrawing() {
  if (isDrawing) return;
  isDrawing = true;
  delete document.documentElement.dataset.drawn;
  requestAnimationFrame(() => setTimeout(drawWaiting, 0));
}

/** Whether a chart is in view, or so many pixels above or below. */
function isWithin(item, margin) {
  const box = item.plot.getBoundingClientRect();
  return box.bottom > -margin && box.top < innerHeight + margin;
}

/** Charts to draw, in their order: those in view, then those drawn before, near, or of a page that draws all. */
function chartsDue() {
  waiting = waiting.filter((item) => item.plot.isConnected);
  const inView = waiting.filter((item) => isWithin(item, 0));
  return [...inView, ...waiting.filter((item) => !inView.includes(item) &&
    (drawsFarCharts || item.drawn || isWithin(item, innerHeight)))];
}

/** Draws what is due. A few charts at a time, so that the page stays alive: one by one it would be laid out and painted as
 * often. */
function drawWaiting() {
  const due = chartsDue(), began = performance.now();
  let drawn = 0;
  while (drawn < due.length && (drawn === 0 || performance.now() - began < drawingTime)) draw(due[drawn++]);
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

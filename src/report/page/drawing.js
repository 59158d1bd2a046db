// When charts are drawn. A report shows its words first, then what is in view, then the rest, a few charts at a time. A page
// that changes under the hand shows words and charts in view together, in one frame, and leaves charts far from view until
// they come near: each costs as much as all of its words.

let waiting = []; // charts not drawn yet, or not as they are now
let isDrawing = false;
let changesUnderHand = false;

const drawingTime = 50; // ms: a page that answers later than that feels slow

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
  return box.bottom > -margin && box.top < innerHeight + margin;
}

/** Charts to draw: those in view, and those near, or of a page that draws all. */
function chartsDue() {
  waiting = waiting.filter((item) => item.plot.isConnected);
  const inView = waiting.filter((item) => isWithin(item, 0));
  const near = waiting.filter((item) => !inView.includes(item) &&
    (!changesUnderHand || item.near || isWithin(item, innerHeight)));
  return { inView, near };
}

/** Draws what is in view at once, where the page changes under the hand; the rest a few charts at a time, so that the page
 * stays alive: one by one it would be laid out and painted as often. */
function drawWaiting() {
  const { inView, near } = chartsDue(), began = performance.now();
  const now = changesUnderHand && inView.length > 0 ? inView : [...inView, ...near];
  let drawn = 0;
  try {
    while (drawn < now.length && (drawn === 0 || now === inView || performance.now() - began < drawingTime)) draw(now[drawn++]);
  } finally {
    if (drawn < inView.length + near.length) {
      setTimeout(drawWaiting, 0);
    } else {
      isDrawing = false;
      document.documentElement.dataset.drawn = "all";
    }
  }
}

/** A screen ahead: who scrolls finds the chart drawn. */
const comingNear = new IntersectionObserver((entries) => {
  for (const entry of entries) chartItems.get(entry.target.id).near = entry.isIntersecting;
  const due = chartsDue();
  if (due.inView.length + due.near.length > 0) beginDrawing();
}, { rootMargin: "100% 0px" });

// Colours of the charts: those that the program gives (styles.hpp), on white paper, and the same on a dark screen, each
// light enough to be read there. Paper is always white.

const styles = {}; // what charts are drawn with now
const darkScreen = matchMedia("(prefers-color-scheme: dark)");

const onDark = {
  colours: { black: "#ececec", blue: "#62b5ea", red: "#ff9a57", green: "#3fd0a6", purple: "#e29ccd", grey: "#b0b0b0" },
  shades: { stick: "rgba(255,255,255,0.10)", slip: "rgba(230,159,0,0.22)", beyond: "rgba(255,255,255,0.15)",
    "left-out": "rgba(226,156,205,0.28)", range: "rgba(226,156,205,0.4)" },
  grid: "#3a3a3a", axis: "#bdbdbd", text: "#ececec", disc: "#4a4a4a", sticking: "#2f5871", slipping: "#7a5a1c",
  paper: "#1a1a1a", halo: "rgba(26,26,26,0.75)",
};

function rgba(colour, opacity) {
  const part = (k) => parseInt(colour.slice(1 + 2 * k, 3 + 2 * k), 16);
  return `rgba(${part(0)},${part(1)},${part(2)},${opacity})`;
}

/** The styles of a report as the screen wants them. */
function themed(given, dark) {
  if (!dark) return { ...given, dark, paper: "#ffffff", halo: "rgba(255,255,255,0.8)" };
  const pale = Object.fromEntries(Object.entries(onDark.colours).map(([name, colour]) => [name, rgba(colour, 0.25)]));
  const shades = Object.fromEntries(Object.entries(given.shades).map(([name, shade]) =>
    [name, { ...shade, fill: onDark.shades[name] || shade.fill }]));
  return { ...given, ...onDark, dark, pale, shades };
}

let givenStyles = null;
function setTheme(dark) {
  if (givenStyles) Object.assign(styles, themed(givenStyles, dark));
}

/** Does something with the colours of paper, then goes back to those of the screen. */
function onPaper(action) {
  const dark = styles.dark;
  setTheme(false);
  try {
    return action();
  } finally {
    setTheme(dark);
  }
}

// Colours of the charts: those that the program gives (styles.hpp), on white paper, and the same on a dark screen, each
// light enough to be read there. Paper is always white.

const styles = {}; // what charts are drawn with now
const darkScreen = matchMedia("(prefers-color-scheme: dark)");

const onDark = {
  colours: { black: "#ececec", blue: "#62b5ea", red: "#ff9a57", green: "#3fd0a6", purple: "#e29ccd", grey: "#b0b0b0" },
  shades: { stick: ["#ffffff", 0.1], slip: ["#e69f00", 0.22], beyond: ["#ffffff", 0.15], "left-out": ["#e29ccd", 0.28],
    range: ["#e29ccd", 0.4] },
  pale: 0.25, grid: "#3a3a3a", axis: "#bdbdbd", text: "#ececec", disc: "#4a4a4a", sticking: "#2f5871", slipping: "#7a5a1c",
  paper: "#1a1a1a", halo: "rgba(26,26,26,0.75)",
};

function rgba(colour, opacity) {
  const part = (k) => parseInt(colour.slice(1 + 2 * k, 3 + 2 * k), 16);
  return `rgba(${part(0)},${part(1)},${part(2)},${opacity})`;
}

/** The styles of a report as the screen wants them. */
function themed(given, dark) {
  const each = (members, make) => Object.fromEntries(Object.entries(members).map(([name, value]) => [name, make(value, name)]));
  const base = { ...given, paper: "#ffffff", halo: "rgba(255,255,255,0.8)", ...(dark ? onDark : {}), dark };
  return { ...base,
    dashes: each(given.dashes, (lengths) => lengths.filter((length) => length > 0).map((length) => `${length}px`).join() || "solid"),
    pale: each(base.colours, (colour, name) => rgba(colour, dark ? onDark.pale : given.pale[name])),
    shades: each(given.shades, ({ meaning, colour, opacity }, name) =>
      ({ meaning, fill: rgba(...(dark ? onDark.shades[name] : [colour, opacity])) })) };
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

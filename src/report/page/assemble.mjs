// Makes page_template.cpp: the page as a string literal, with every script known to its Content-Security-Policy by hash.
// usage: node assemble.mjs OUTPUT.cpp LIBRARY.js index.html STYLE.css... SCRIPT.js...
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";

const [output, libraryPath, htmlPath, ...others] = process.argv.slice(2);
const read = (path) => readFileSync(path, "utf8");
const all = (ending) => others.filter((path) => path.endsWith(ending)).map(read).join("\n");

// Within a page a script ends at the first "</script", wherever that stands.
const library = read(libraryPath).replace(/<(?=\/script|!--)/gi, "\\x3c");
const own = '"use strict";\n' + all(".js");
if (/<\/script|<!--/i.test(own)) throw new Error("a script of the page holds '</script' or '<!--'");
const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

const policy = [
  "default-src 'none'",
  `script-src ${hash(library)} ${hash(own)}`,
  "style-src 'unsafe-inline'", // the library sets styles of what it draws
  "img-src data: blob:", // pictures that are saved
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");

const parts = {
  "@POLICY@": policy,
  "@STYLE@": all(".css"),
  "@LIBRARY@": library,
  "@SCRIPT@": own,
};
const page = read(htmlPath).replace(/@(POLICY|STYLE|LIBRARY|SCRIPT)@/g, (mark) => parts[mark]);
if (page.split(/@TITLE@|@DATA@/).length !== 3) throw new Error("the page must hold @TITLE@, then @DATA@, each once");

// Characters beyond ASCII are written as octal bytes, and so are " and \\ and what would be a trigraph.
const isPlain = (b) => b >= 0x20 && b < 0x7f && b !== 0x22 && b !== 0x5c && b !== 0x3f;
const lines = ['#pragma GCC diagnostic ignored "-Woverlength-strings"', "#include <string_view>", "", "namespace tribofit {",
  "std::string_view page_template() {", "  return"];
const bytes = Buffer.from(page, "utf8");
for (let begin = 0; begin < bytes.length; begin += 16000) {
  let line = "";
  for (const b of bytes.subarray(begin, begin + 16000)) {
    line += isPlain(b) ? String.fromCharCode(b) : "\\" + b.toString(8).padStart(3, "0");
  }
  lines.push(`    "${line}"`);
}
writeFileSync(output, [...lines, "    ;", "}", "}  // namespace tribofit", ""].join("\n"));

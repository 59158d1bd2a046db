// Makes page_parts.cpp: the page as string literals, with every script known to its Content-Security-Policy by hash.
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
const pieces = page.split(/@TITLE@|@DATA@/);
if (pieces.length !== 3) throw new Error("the page must hold @TITLE@, then @DATA@, each once");

// Literals stay below 64 KiB, the least a compiler must take; characters beyond ASCII are written as octal bytes.
function literals(text) {
  const bytes = Buffer.from(text, "utf8");
  const plain = (b) => b >= 0x20 && b < 0x7f && b !== 0x22 && b !== 0x5c && b !== 0x3f; // no ", \ or trigraph
  const lines = [];
  for (let begin = 0; begin < bytes.length; begin += 16000) {
    let line = "";
    for (const b of bytes.subarray(begin, begin + 16000)) {
      line += plain(b) ? String.fromCharCode(b) : "\\" + b.toString(8).padStart(3, "0");
    }
    lines.push(`    "${line}"sv,\n`);
  }
  return lines.join("");
}

let source = '#include <string_view>\n\n#include "report/page_parts.hpp"\n\nnamespace tribofit {\nnamespace {\n\nusing std::literals::operator""sv;\n\n';
["kHead", "kMiddle", "kTail"].forEach((name, k) => {
  source += `constexpr std::string_view ${name}[] = {\n${literals(pieces[k])}};\n\n`;
});
source += "}  // namespace\n\nPageParts page_parts() {\n  return {kHead, kMiddle, kTail};\n}\n\n}  // namespace tribofit\n";
writeFileSync(output, source);

// Flies the flights in WebAssembly and compares each line with those of this machine: node compare.cjs FOLDER NATIVE.txt
const fs = require("fs");
const path = require("path");

const [folder, native] = process.argv.slice(2);
const { lines, parts } = require(path.resolve(folder, "lensrunner_bits.js"));
const expected = fs.readFileSync(native, "utf8").trimEnd().split("\n");

// The first line that differs, or null.
function difference(found) {
  const length = Math.max(found.length, expected.length);
  for (let k = 0; k < length; k++) {
    if (found[k] !== expected[k]) return `WebAssembly: ${found[k]}\nhere:        ${expected[k]}`;
  }
  return null;
}

const flown = (wrong) => parts().flatMap((part) => lines(part, wrong).trimEnd().split("\n"));
const begin = Date.now();
const different = difference(flown(false));
if (different) {
  console.error(`not the same bits:\n${different}`);
  process.exit(1);
}
console.log(`${expected.length} hashes are equal, ${((Date.now() - begin) / 1000).toFixed(0)} s in WebAssembly`);
// One bit off in one number is found, as is a sine of another library.
const off = lines(parts()[0], true).trimEnd().split("\n");
if (off.every((line, k) => line === expected[k])) {
  console.error("a ship that is off by one bit is not found");
  process.exit(1);
}

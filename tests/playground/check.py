#!/usr/bin/env python3
"""Opens the playground in headless Chromium, moves every control and checks what the page shows:
check.py index.html [include folder, compiler...]

With a compiler, the programs that the page shows have to compile, in the compiled form, which names most headers. Prints the
time of a frame for each kind of picture. Exit codes: 0 without faults, 1 with faults, 77 without Chromium.
"""

import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from browser import Browser, chromium_program

# Runs inside the page and returns what it found as JSON.
DRIVER = """
(async () => {
  const found = {faults: [], frames: {}, programs: []};
  const root = document.documentElement, form = document.getElementById("controls");
  const canvas = document.getElementById("picture");
  const frames = () => Number(root.dataset.frames || 0);
  const pause = () => new Promise(done => setTimeout(done, 5));
  const until = async (what, condition) => {
    for (let i = 0; i < 4000; ++i) { if (condition()) return; await pause(); }
    found.faults.push("never: " + what);
  };
  const picture = () => canvas.toDataURL();
  const set = async (name, value) => {
    const before = frames();
    form.elements[name].value = value;
    form.dispatchEvent(new Event("input"));
    await until(name + " = " + value + " is drawn", () => frames() > before);
    const shown = document.getElementById("code").textContent;
    if (!found.programs.includes(shown)) found.programs.push(shown);
  };
  await until("the first frame", () => frames() > 0);
  for (const mode of [0, 1, 2]) {
    await set("mode", mode);
    const changes = {altitude: 6.5, yaw: 100, burial: 0.5, target: 3, bottom: 3, look: 1, overlay: 2, speckle: 0, seed: 20};
    if (mode === 0) changes.grazing = 20;
    for (const [name, value] of Object.entries(changes)) {
      const before = picture(), old = form.elements[name].value;
      await set(name, value);
      if (picture() === before) found.faults.push("mode " + mode + ": " + name + " changes nothing");
      await set(name, old);
      if (picture() !== before) found.faults.push("mode " + mode + ": " + name + " does not come back");
    }
    const times = [];
    for (let i = 0; i < 9; ++i) {
      await set("yaw", 10 * i);
      times.push(Number(root.dataset.ms));
    }
    found.frames[mode] = times.sort((a, b) => a - b)[4];
    for (const bottom of [0, 1, 2, 3, 4]) await set("bottom", bottom);
    for (const target of [0, 1, 2, 3, 4, 5, 6, 7]) await set("target", target);
    for (const [name, value] of [["altitude", 1.5], ["altitude", 12], ["size", 1024], ["size", 128], ["size", 512]])
      await set(name, value);
    for (const name of ["bottom", "target", "altitude", "yaw"])
      await set(name, {bottom: 1, target: 1, altitude: 4, yaw: 60}[name]);
  }
  if (!document.getElementById("code").textContent.includes("in::render(scene")) found.faults.push("no program shown");
  if (document.getElementById("error").textContent) found.faults.push(document.getElementById("error").textContent);
  return JSON.stringify(found);
})()
"""


STB = "int stbi_write_png_to_func(void (*)(void*, void*, int), void*, int, int, int, const void*, int);\n"


def compiler_faults(programs, include, compiler):
    """Compiles the programs in the compiled form, one unit for each set of includes, and yields the errors."""
    if len(programs) < 50:
        yield f"the page showed {len(programs)} programs"
    units = {}
    for program in programs:
        headers = "\n".join(re.findall(r"#include.*", program))
        body = re.sub(r"#include.*\n", "", program).replace("int main()", f"void draw_{len(units.get(headers, []))}()")
        units.setdefault(headers, []).append(body.replace("namespace in = insonify;", "").replace("\nusing ", "\n// using "))
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "stb_image_write.h").write_text('extern "C" ' + STB)

        def fault(unit):
            headers, bodies = unit
            text = "\n".join([headers, "namespace in = insonify;", "using namespace in::literals;", *bodies])
            done = subprocess.run([*compiler, "-std=c++20", "-fsyntax-only", "-DINSONIFY_COMPILED", f"-I{include}",
                                   f"-I{folder}", "-x", "c++", "-"], input=text, capture_output=True, text=True)
            return f"a program does not compile: {done.stderr[:2000]}" if done.returncode != 0 else None

        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            yield from filter(None, pool.map(fault, units.items()))


def main():
    chromium = chromium_program()
    if chromium is None:
        print("skipped: Chromium not found")
        sys.exit(77)
    page = pathlib.Path(sys.argv[1]).resolve()
    size = page.stat().st_size
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        browser = Browser(chromium, folder)
        try:
            session = browser.open(page.as_uri())
            answer = browser.call("Runtime.evaluate", session, expression=DRIVER, awaitPromise=True)
            found = json.loads(answer["result"]["value"])
        finally:
            browser.process.kill()
            browser.process.wait()
    faults = list(browser.complaints()) + found["faults"]
    if len(sys.argv) > 2:
        faults += compiler_faults(found["programs"], sys.argv[2], sys.argv[3:])
    if size > 1.5e6:
        faults.append(f"{size} bytes, at most 1.5 million")
    print(f"{size / 1e6:.2f} MB; milliseconds a frame of 512 x 512:", found["frames"])
    print("\n".join(faults) or "no fault")
    sys.exit(1 if faults else 0)


main()

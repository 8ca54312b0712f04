#!/usr/bin/env python3
"""Opens preview.html of a data set in headless Chromium and uses its controls: preview_test.py <generate_dataset>

INSONIFY_PREVIEW: number of images of the set (300; tools/test --full: 20100, of which the page shows a half).
Exit code 77: Chromium not found.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))
from browser import Browser, chromium_program

COUNT = int(os.environ.get("INSONIFY_PREVIEW", "300"))
DRIVER = """
(async () => {
  const faults = [], $ = id => document.getElementById(id);
  const pause = ms => new Promise(done => setTimeout(done, ms));
  const expect = (what, holds) => { if (!holds) faults.push(what); };
  const set = (id, value) => { $(id).value = value; $(id).dispatchEvent(new Event("input")); };
  const cells = () => [...document.querySelectorAll(".cell")];
  const loaded = async () => {
    for (let i = 0; i < 400; ++i) {
      const images = [...document.querySelectorAll(".cell img")];
      if (images.length && images.every(i => i.complete)) return images.every(i => i.naturalWidth > 0);
      await pause(25);
    }
    return false;
  };
  const count = () => Number($("count").textContent.split(" ")[0]);
  expect("all images are shown: " + count(), count() === rows.length &&
         (rows.length === COUNT || COUNT > 20000 && Math.abs(rows.length / COUNT - 0.5) < 0.02));
  expect("only cells in view are in the page: " + cells().length, cells().length > 0 && cells().length < 200);
  expect("thumbnails load", await loaded());
  const classes = [...$("class").options].map(o => o.value).filter(Boolean);
  let sum = 0;
  for (const name of classes) {
    set("class", name);
    sum += count();
    expect("a class filter shows only its class", cells().every(c => c.title.includes("class: " + name)));
  }
  expect("classes add up: " + sum, sum === rows.length && classes.length === 4);
  set("class", "");
  sum = 0;
  for (const o of [...$("bottom").options].slice(1)) { set("bottom", o.value); sum += count(); }
  expect("bottoms add up: " + sum, sum === rows.length);
  set("bottom", "");
  const column = names.indexOf("slant_range_m"), values = rows.map(r => r[3 + column]).sort((a, b) => a - b);
  set("column", column);
  const middle = values[values.length >> 1];
  set("low", middle);
  expect("from the median on is half: " + count(), count() === values.filter(v => v >= middle).length);
  set("high", middle - 1);
  expect("an empty range shows nothing", count() === 0 && cells().length === 0);
  set("low", ""), set("high", "");
  const metres = rows[0][3 + names.indexOf("metres_per_pixel")] * rows[0][3 + names.indexOf("size_px")];
  const first = cells()[0], tag = first.querySelector("b").textContent.split(" ");
  expect("an image has its extent and direction: " + tag, Math.abs(tag[0] / metres - 1) < 0.01 && tag[2] === "\\u2192");
  first.dispatchEvent(new MouseEvent("mouseenter"));
  expect("masks come on hover", first.querySelectorAll(".tint img").length === 2 && await loaded());
  $("main").scrollTop = $("main").scrollHeight;
  await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
  await pause(200);
  expect("the last image is reached", cells().some(c => c.textContent.startsWith(rows[rows.length - 1][0])));
  expect("its thumbnail loads", await loaded());
  expect("few cells remain: " + cells().length, cells().length < 200);
  const charts = document.querySelectorAll(".bars");
  expect("there are histograms: " + charts.length, charts.length > 10);
  for (const bars of charts)
    expect("a histogram counts all", [...bars.children].reduce((n, b) => n + Number(b.title), 0) <= rows.length);
  const start = performance.now();
  for (const name of classes) set("class", name);
  return JSON.stringify({faults, filter_ms: (performance.now() - start) / classes.length});
})()
""".replace("COUNT", str(COUNT))
# Charts of the recipe sonar may be turned; the tag of an image is its extent in range, which then runs up or down.
TURNED = """
(() => {
  const faults = [], of = (r, name) => r[3 + names.indexOf(name)];
  let sideways = 0;
  for (const r of rows) {
    const turn = of(r, "turn") % 2, [metres, , arrow] = extent(r).split(" ");
    const across = of(r, turn ? "metres_per_row" : "metres_per_pixel") * of(r, "size_px");
    if (Math.abs(metres / across - 1) > 0.01) faults.push(r[0] + " is " + across + " m in range, and tagged " + metres);
    if (turn !== ("\u2191\u2193".includes(arrow) ? 1 : 0)) faults.push(r[0] + " has turn " + turn + " and " + arrow);
    sideways += turn;
  }
  if (!sideways) faults.push("no image is turned");
  return JSON.stringify({faults});
})()
"""


def used(browser, page, script):
    """The answer of a script in a page."""
    session = browser.open(page.as_uri())
    answer = browser.call("Runtime.evaluate", session, expression=script, awaitPromise=True)
    if "value" not in answer.get("result", {}):
        raise RuntimeError(json.dumps(answer)[:500])
    return json.loads(answer["result"]["value"])


def preview(out, *options):
    """The page of a set that is made with these options."""
    subprocess.run([sys.argv[1], "--out", out, *options, "--preview"], check=True)
    return out / "preview.html"


def main():
    chromium = chromium_program()
    if chromium is None:
        print("skipped: Chromium not found")
        sys.exit(77)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        page = preview(pathlib.Path(folder) / "a <set> & more", "--recipe", "published", "--size", "32", "--count", str(COUNT))
        turned = preview(pathlib.Path(folder) / "turned", "--count", "40")
        browser = Browser(chromium, str(pathlib.Path(folder) / "profile"))
        try:
            start = time.monotonic()
            found = used(browser, page, DRIVER)
            print(f"{COUNT} images: {page.stat().st_size / 1e6:.2f} MB, used in {time.monotonic() - start:.1f} s, a filter "
                  f"takes {found['filter_ms']:.0f} ms")
            found["faults"] += used(browser, turned, TURNED)["faults"]
        finally:
            browser.process.kill()
            browser.process.wait()
    faults = list(browser.complaints()) + found["faults"]
    print("\n".join(faults) or "no fault")
    sys.exit(1 if faults else 0)


main()

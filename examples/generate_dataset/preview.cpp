#include "preview.hpp"

#include <insonify/core/random.hpp>

namespace generator {

namespace {

/// JSON for a <script> element: "<" is escaped, so that no string ends the element.
std::string embedded(const json& value) {
    std::string text;
    for (const char c : value.dump(-1, ' ', true, json::error_handler_t::replace))
        if (c == '<')
            text += "\\u003c";
        else
            text += c;
    return text;
}

constexpr const char* page_head = R"page(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1"><title>Data set</title><style>
body{margin:0;font:14px/1.4 system-ui,sans-serif;background:#181818;color:#ddd;display:flex;height:100vh}
aside{width:19em;padding:1em;overflow-y:auto;background:#222;box-sizing:border-box;flex:none}
main{flex:1;overflow-y:scroll;overflow-anchor:none;position:relative}
h1{font-size:1.1em;margin:0 0 .5em;overflow-wrap:anywhere}h2{font-size:.9em;margin:1em 0 0;font-weight:normal}
label{display:block;margin:.4em 0}select,input{width:100%;box-sizing:border-box}label.in-line input{width:auto}
.pair{display:flex;gap:.4em}#grid{position:relative}
.cell{position:absolute;margin:4px;background:#000}.cell figcaption{position:absolute;left:0;right:0;bottom:0;
background:#000a;font-size:11px;padding:1px 4px;overflow:hidden;white-space:nowrap}
.cell img,.tint{position:absolute;inset:0;width:100%;height:100%;image-rendering:auto}
.tint{mix-blend-mode:screen;isolation:isolate;display:none}.tint i{position:absolute;inset:0;mix-blend-mode:multiply}
.target i{background:#e60}.shadow i{background:#06d}.cell:hover .tint,.all .tint{display:block}
.bars{display:flex;align-items:flex-end;height:40px;gap:1px}.bars i{flex:1;background:#8ac;min-height:0}
.ends{display:flex;justify-content:space-between;font-size:11px;color:#999}
.cell b{position:absolute;right:0;top:0;background:#000a;font:11px system-ui;padding:1px 4px}
.note{color:#999;font-size:12px;margin:.6em 0}summary{margin-top:.8em;cursor:pointer}
@media(max-width:640px){body{flex-direction:column}aside{width:auto;max-height:45vh}main{min-height:0}}
</style></head><body><aside><h1 id="title"></h1><div id="count"></div>
<label>Class<select id="class"></select></label><label>Bottom<select id="bottom"></select></label>
<label>Range of <select id="column"></select></label>
<div class="pair"><input id="low" type="number" step="any" aria-label="from" placeholder="from"><input id="high" type="number" step="any" aria-label="to" placeholder="to"></div>
<label class="in-line"><input id="masks" type="checkbox"> masks of all images</label>
<label>Size of the images<input id="size" type="range" min="64" max="512" value="160"></label>
<div class="note">On each image, its extent in range and an arrow that points away from the sonar. Masks: target orange, shadow
blue; also shown under the pointer, with all parameters.</div>
<details id="charts" open><summary>Histograms of the images shown</summary><div id="histograms"></div></details></aside>
<main id="main"><div id="grid"></div></main><script>
"use strict";
const data = )page";

constexpr const char* page_tail = R"page(;
const $ = id => document.getElementById(id);
const names = data.names, rows = data.rows;
const at = {cls: 1, bottom: 2, first: 3};  // a row: id, class, bottom, the parameters
const option = (select, value, text) => { const o = document.createElement("option"); o.value = value; o.textContent = text; select.append(o); };
const fill = (id, column) => {
  option($(id), "", "all");
  for (const value of [...new Set(rows.map(r => r[column]))].sort()) option($(id), value, value);
};
const numeric = names.map((_, i) => i).filter(i => {
  const seen = new Set();
  for (const r of rows) { const v = r[at.first + i]; if (typeof v === "number") seen.add(v); else if (v !== null) return false; if (seen.size > 1) return true; }
  return false;
});
const block = id => "masks/" + id.slice(0, 6) + "/" + id + "_";
const value = (r, name) => names.includes(name) ? r[at.first + names.indexOf(name)] : null;
const extent = r => {
  const turn = value(r, "turn") || 0;
  const metres = value(r, turn % 2 ? "metres_per_row" : "metres_per_pixel") * value(r, "size_px");
  return metres ? Number(metres.toPrecision(3)) + " m " + "\u2192\u2191\u2190\u2193"[turn < 4 ? turn : (turn + 2) % 4] : "";
};
let shown = rows, cells = new Map();
function choose() {
  const c = $("class").value, b = $("bottom").value, k = at.first + Number($("column").value);
  const low = $("low").value === "" ? null : Number($("low").value), high = $("high").value === "" ? null : Number($("high").value);
  shown = rows.filter(r => (!c || r[at.cls] === c) && (!b || r[at.bottom] === b) &&
    (low === null || (r[k] !== null && r[k] >= low)) && (high === null || (r[k] !== null && r[k] <= high)));
  $("count").textContent = shown.length + " of " + rows.length + " shown" +
    (data.step > 1 ? "; about one in " + data.step + " of " + data.images + " images" : "");
  for (const cell of cells.values()) cell.remove();
  cells.clear();
  $("main").scrollTop = 0;
  histograms();
  place();
}
function picture(path, parent) { const i = new Image(); i.decoding = "async"; i.src = path.split("/").map(encodeURIComponent).join("/"); parent.append(i); return i; }
function cell(r) {
  const f = document.createElement("figure"), text = document.createElement("figcaption");
  f.className = "cell";
  picture("images/" + r[at.cls] + "/" + r[0].slice(0, 6) + "/" + r[0] + ".png", f);
  const overlay = kind => { const t = document.createElement("div"); t.className = "tint " + kind; picture(block(r[0]) + kind + ".png", t); t.append(document.createElement("i")); f.insertBefore(t, text); };
  text.textContent = r[0] + " " + r[at.cls] + (r[at.bottom] ? " on " + r[at.bottom] : "");
  f.title = names.map((n, i) => n + ": " + r[at.first + i]).join("\n");
  const tag = document.createElement("b");
  tag.textContent = extent(r);
  f.append(text, tag);
  const masks = () => { if (!f.masked) { f.masked = true; overlay("target"); overlay("shadow"); } };
  f.addEventListener("mouseenter", masks);
  if ($("masks").checked) masks();
  return f;
}
function place() {  // only what is in view is in the page
  const main = $("main"), size = Number($("size").value) + 8, columns = Math.max(1, Math.floor(main.clientWidth / size));
  $("grid").style.height = Math.ceil(shown.length / columns) * size + "px";
  const first = Math.max(0, Math.floor(main.scrollTop / size) - 1) * columns;
  const last = Math.min(shown.length, (Math.ceil((main.scrollTop + main.clientHeight) / size) + 1) * columns);
  for (const [i, c] of cells) if (i < first || i >= last) { c.remove(); cells.delete(i); }
  for (let i = first; i < last; ++i) {
    if (!cells.has(i)) { const c = cell(shown[i]); cells.set(i, c); $("grid").append(c); }
    const s = cells.get(i).style;
    s.left = i % columns * size + "px", s.top = Math.floor(i / columns) * size + "px", s.width = s.height = size - 8 + "px";
  }
}
function histograms() {
  const all = $("histograms");
  all.textContent = "";
  for (const k of numeric) {
    let low = Infinity, high = -Infinity;
    for (const r of rows) { const v = r[at.first + k]; if (v !== null) { low = Math.min(low, v), high = Math.max(high, v); } }
    const bins = new Array(32).fill(0);
    for (const r of shown) { const v = r[at.first + k]; if (v !== null) ++bins[Math.min(31, Math.floor((v - low) / (high - low) * 32))]; }
    const most = Math.max(1, ...bins), title = document.createElement("h2"), bars = document.createElement("div"), ends = document.createElement("div");
    title.textContent = names[k];
    bars.className = "bars", ends.className = "ends";
    for (const n of bins) { const i = document.createElement("i"); i.style.height = 100 * n / most + "%"; i.title = n; bars.append(i); }
    for (const v of [low, high]) { const s = document.createElement("span"); s.textContent = Number(v.toPrecision(4)); ends.append(s); }
    all.append(title, bars, ends);
  }
}
$("title").textContent = document.title = data.title;
fill("class", at.cls);
fill("bottom", at.bottom);
for (const k of numeric) option($("column"), k, names[k]);
for (const k of numeric) if (/^(slant|ground)_range_m$/.test(names[k])) $("column").value = k;
for (const id of ["class", "bottom", "column", "low", "high"]) $(id).addEventListener("input", choose);
$("masks").addEventListener("input", () => { $("grid").classList.toggle("all", $("masks").checked); for (const c of cells.values()) c.remove(); cells.clear(); place(); });
$("size").addEventListener("input", place);
$("main").addEventListener("scroll", place, {passive: true});
addEventListener("resize", place);
$("charts").open = innerWidth > 640;
choose();
</script></body></html>
)page";

}  // namespace

void preview_page::add(const json& record) {
    const std::uint32_t lot = insonify::random_sequence(0, 0, images_++).word();
    if (lot % step_ != 0) return;
    const json& parameters = record.at("parameters");
    if (names_.empty())
        for (const auto& [name, value] : parameters.items()) names_.push_back(name);
    const std::string image = record.at("files").at(0).at("path").get<std::string>();
    const std::size_t class_end = image.find('/', 7), id = image.rfind('/') + 1;
    json cells{image.substr(id, image.rfind('.') - id), image.substr(7, class_end - 7)};
    const auto bottom =
        parameters.find("seabed") != parameters.end() ? parameters.find("seabed") : parameters.find("bottom");
    cells.push_back(bottom != parameters.end() && bottom->is_string() ? *bottom : json(""));
    for (const std::string& name : names_) cells.push_back(parameters.value(name, json()));
    rows_.push_back({lot, embedded(cells)});
    while (rows_.size() > max_rows) {
        step_ *= 2;
        std::erase_if(rows_, [&](const row& r) { return r.lot % step_ != 0; });
    }
}

std::string preview_page::text(const std::string& title) const {
    std::string page = page_head;
    page += "{\"title\":" + embedded(title) + ",\"images\":" + std::to_string(images_) +
            ",\"step\":" + std::to_string(step_) + ",\"names\":" + embedded(names_) + ",\"rows\":[\n";
    for (std::size_t i = 0; i < rows_.size(); ++i) page += (i == 0 ? "" : ",\n") + rows_[i].text;
    return page + "\n]}" + page_tail;
}

}  // namespace generator

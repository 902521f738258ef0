// The style sheet of the reports (app/html_page.h): system fonts, one measure, colours as variables that dark
// mode changes and paper resets. It holds no '<' and no '&', so that it reads the same as HTML and as XML.

#include "app/html_page.h"

namespace serosa::app {

namespace {

constexpr std::string_view kStyle = R"css(
:root {
  color-scheme: light dark;
  --paper: #ffffff; --panel: #f5f7f8; --ink: #1b2126; --soft: #5a6670; --rule: #dfe4e8; --axis: #9aa5ae;
  --good: #17703c; --good-panel: #e9f5ee; --warning: #8a5a00; --warning-panel: #fdf4df;
  --bad: #b3261e; --bad-panel: #fcecea;
  --s1: #1f63b5; --s2: #c4540a; --s3: #1d8561; --s4: #8446b3; --s5: #a07d12; --s6: #c2306f; --s7: #26869e; --s8: #6a7178;
}
@media screen and (prefers-color-scheme: dark) {
  :root {
    --paper: #15191c; --panel: #1d2327; --ink: #e3e8eb; --soft: #9ba7b0; --rule: #313a40; --axis: #66727b;
    --good: #6fce98; --good-panel: #16291e; --warning: #e5b558; --warning-panel: #2c2413;
    --bad: #ff8f85; --bad-panel: #351a18;
    --s1: #6caaf2; --s2: #f59248; --s3: #55c79b; --s4: #c294ea; --s5: #d6b34a; --s6: #f27fae; --s7: #63c0d8; --s8: #a9b1b8;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; text-size-adjust: 100%; }
body {
  margin: 0 auto; padding: 2.25rem 1.5rem 3rem; max-width: 61rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "Helvetica Neue", Arial, sans-serif;
  font-variant-numeric: tabular-nums lining-nums;
}
h1 { margin: 0; font-size: 1.75rem; line-height: 1.2; font-weight: 650; letter-spacing: -0.012em; overflow-wrap: anywhere; }
h2 { margin: 2.75rem 0 0.9rem; font-size: 1.2rem; line-height: 1.3; font-weight: 650; overflow-wrap: anywhere; }
h2 .count { color: var(--soft); font-weight: 400; }
p { margin: 0.4rem 0; max-width: 46rem; }
a { color: inherit; text-decoration-color: var(--axis); text-underline-offset: 0.15em; }
code { font: 0.9em/1 ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace; }
.subtitle, .note, .unit, figcaption, footer { color: var(--soft); }
p.note { font-size: 0.85rem; }
section > figure:last-child, .pair > figure { margin-bottom: 0.5rem; }
.subtitle { margin: 0.3rem 0 1.4rem; font-size: 0.9rem; overflow-wrap: anywhere; }

.verdict { display: flex; gap: 0.9rem; align-items: baseline; padding: 0.8rem 1.1rem; border-radius: 6px; border-left: 4px solid; }
.verdict p { margin: 0; overflow-wrap: anywhere; }
.verdict .mark { font-weight: 700; }
.verdict span { color: var(--ink); }
.verdict.good { background: var(--good-panel); border-color: var(--good); }
.verdict.warning { background: var(--warning-panel); border-color: var(--warning); }
.verdict.bad { background: var(--bad-panel); border-color: var(--bad); }
.verdict.good strong, .verdict.good .mark { color: var(--good); }
.verdict.warning strong, .verdict.warning .mark { color: var(--warning); }
.verdict.bad strong, .verdict.bad .mark { color: var(--bad); }

.key { display: grid; grid-template-columns: repeat(auto-fill, minmax(9.2rem, 1fr)); gap: 1.1rem 1.5rem; margin: 1.6rem 0 0; }
.key div { border-top: 1px solid var(--rule); padding-top: 0.5rem; min-width: 0; }
.key dt { color: var(--soft); font-size: 0.85rem; }
.key dd { margin: 0; overflow-wrap: anywhere; }
.key .value { font-size: 1.35rem; line-height: 1.35; font-weight: 600; letter-spacing: -0.01em; }
.key .note { font-size: 0.85rem; line-height: 1.35; }

figure { margin: 0 0 1.9rem; break-inside: avoid; }
figcaption { font-size: 0.9rem; }
figcaption strong { color: var(--ink); font-weight: 600; font-size: 1rem; }
figcaption .note { margin-left: 0.5rem; }
.picture img { display: block; width: 100%; height: auto; border-radius: 4px; border: 1px solid var(--rule); background: var(--panel); }
.picture figcaption { margin-top: 0.45rem; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 1fr)); gap: 0 1.5rem; }

.legend { display: flex; flex-wrap: wrap; gap: 0.1rem 1.6rem; margin: 0.2rem 0 0.5rem; padding: 0; list-style: none; font-size: 0.9rem; }
.legend .extreme { color: var(--soft); }
.legend .name { overflow-wrap: anywhere; }
.swatch { width: 26px; height: 10px; margin-right: 0.5rem; }
.plot svg { max-width: 100%; overflow: visible; }
.plot svg:not(.swatch) { display: block; width: 100%; height: auto; }
svg text { fill: var(--soft); font-size: 13px; }
svg line { stroke: var(--rule); stroke-width: 1; }
svg .zero, svg .tick { stroke: var(--axis); }
.series polyline, .series line { fill: none; stroke: currentColor; stroke-width: 1.8; stroke-linejoin: round; stroke-linecap: round; }
.series .dot { fill: currentColor; }
.series .peak { fill: var(--paper); stroke: currentColor; stroke-width: 1.8; }
.s1 { color: var(--s1); } .s2 { color: var(--s2); } .s3 { color: var(--s3); } .s4 { color: var(--s4); }
.s5 { color: var(--s5); } .s6 { color: var(--s6); } .s7 { color: var(--s7); } .s8 { color: var(--s8); }

.scroll { overflow-x: auto; margin: 0 0 1.6rem; break-inside: avoid; }
table { border-collapse: collapse; width: 100%; font-size: 0.925rem; line-height: 1.4; }
caption { text-align: left; padding: 0 0 0.35rem; font-weight: 600; }
th, td { padding: 0.32rem 1.1rem 0.32rem 0; text-align: left; vertical-align: baseline; border-top: 1px solid var(--rule); }
th:last-child, td:last-child { padding-right: 0; }
thead th, thead td { border-top: 0; color: var(--soft); font-weight: 500; font-size: 0.85rem; vertical-align: bottom; }
thead + tbody tr:first-child > * { border-top-color: var(--axis); }
tbody th { font-weight: 400; }
.properties { width: auto; min-width: min(100%, 25rem); }
.properties tbody th { color: var(--soft); min-width: 9.5rem; }
.properties .note { font-size: 0.85rem; }
.properties thead th { text-align: left; overflow-wrap: anywhere; }
.properties .value { overflow-wrap: anywhere; }
.tables { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); gap: 0 2.5rem; align-items: start; }
.tables .properties { width: 100%; }
.tables tbody th { width: 54%; }
.stack .properties { width: 100%; }
.stack tbody th, .stack thead td:first-child { width: 16rem; }
.stack .value { min-width: 6.5rem; }
.number { text-align: right; white-space: nowrap; }
.tools { width: auto; min-width: min(100%, 38rem); }
.unit-cell { color: var(--soft); max-width: 5.5rem; }
.result { white-space: nowrap; font-weight: 600; width: 5.5rem; }
.pass { color: var(--good); } .fail { color: var(--bad); } .skip { color: var(--warning); }
.checks th, .checks td { padding-right: 0.9rem; }
.checks .name { min-width: 14rem; overflow-wrap: anywhere; }
.checks .why { color: var(--soft); }
tr.failed > * { background: var(--bad-panel); }
tr.failed > :first-child { box-shadow: -0.5rem 0 var(--bad-panel); }
tr.failed > :last-child { box-shadow: 0.5rem 0 var(--bad-panel); }
.checks-scroll { margin-left: -0.5rem; margin-right: -0.5rem; padding: 0 0.5rem; }
.share { white-space: nowrap; width: 8rem; }
.share svg { width: 3.5rem; height: 7px; margin-right: 0.5rem; border-radius: 3.5px; background: var(--rule); }
.share rect { fill: var(--soft); }
.failed .share rect { fill: var(--bad); }
footer { margin-top: 3rem; padding-top: 0.8rem; border-top: 1px solid var(--rule); font-size: 0.85rem; }

@media screen and (max-width: 40rem) {
  body { padding: 1.4rem 1rem 2rem; }
  h1 { font-size: 1.45rem; }
  .key { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 0.9rem 1.1rem; }
  .key .value { font-size: 1.15rem; }
  figcaption .note { display: block; margin-left: 0; }
  svg text { font-size: 24px; }
  .series polyline { stroke-width: 3; }
  .properties tbody th { min-width: 7.5rem; }
  .stack tbody th, .stack thead td:first-child { width: 7.5rem; }
  .tools { min-width: 0; }
  .checks thead { display: none; }
  .checks, .checks tbody, .checks tr, .checks th, .checks td { display: block; width: auto; max-width: none; }
  .checks tr { padding: 0.55rem 0; border-top: 1px solid var(--rule); }
  .checks tr.failed { background: var(--bad-panel); box-shadow: -0.5rem 0 var(--bad-panel), 0.5rem 0 var(--bad-panel); }
  .checks th, .checks td { border: 0; padding: 0; min-width: 0; }
  .checks .name { margin-bottom: 0.3rem; min-width: 0; }
  .checks td[data-label] { display: flex; text-align: left; font-size: 0.875rem; white-space: normal; align-items: baseline; }
  .checks td[data-label]::before { content: attr(data-label); color: var(--soft); flex: 0 0 8.5rem; }
}
@media print {
  :root { color-scheme: light; }
  @page { margin: 16mm 14mm; }
  body { max-width: none; padding: 0; font-size: 9.5pt; }
  h2 { break-after: avoid; margin-top: 1.6rem; }
  .verdict, tr.failed > *, .share svg { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  tr { break-inside: avoid; }
  .scroll { overflow: visible; }
  .key { grid-template-columns: repeat(5, minmax(0, 1fr)); gap: 0.6rem 1rem; }
  .key .value { font-size: 1.1rem; }
  .tables { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 0 1.5rem; }
  .properties tbody th { min-width: 0; }
  .checks-scroll { break-inside: auto; }
  .s2 polyline, .s2 line { stroke-dasharray: 7 4; }
  .s3 polyline, .s3 line { stroke-dasharray: 2 4; }
  .s4 polyline, .s4 line { stroke-dasharray: 9 3 2 3; }
}
)css";

} // namespace

std::string_view reportStyle() {
    return kStyle;
}

} // namespace serosa::app

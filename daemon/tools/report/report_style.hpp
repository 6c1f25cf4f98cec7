#pragma once

#include <string_view>

namespace yuragi::daemon::tools::report {

/// The style sheet: dark if the reader's system is, light in print.
inline constexpr std::string_view kReportStyle = R"css(
:root { color-scheme: light dark; --ink: #1c2733; --quiet: #5b6875; --paper: #ffffff; --card: #f4f7fa; --line: #d5dde5;
        --accent: #2f7fc1; --warn: #fff3d6; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e4eaf0; --quiet: #9aa8b5; --paper: #12181f; --card: #1b232c; --line: #34404c; --accent: #6db1ea;
          --warn: #4a3a10; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 62rem; padding: 2rem 1.25rem 4rem; background: var(--paper); color: var(--ink);
       font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 .3rem; overflow-wrap: anywhere; }
h2 { font-size: 1.35rem; margin: 2.8rem 0 .4rem; padding-top: .8rem; border-top: 2px solid var(--accent);
     overflow-wrap: anywhere; }
h3 { font-size: 1.05rem; margin: 1.8rem 0 .3rem; }
p { margin: .3rem 0 .8rem; } .lead { font-size: 1.12rem; } .quiet { color: var(--quiet); font-size: .9rem; }
.warn { background: var(--warn); border-left: 4px solid #e0a100; padding: .5rem .8rem; }
table { border-collapse: collapse; font-size: .93rem; margin: .4rem 0 1rem; font-variant-numeric: tabular-nums; }
th, td { padding: .22rem .9rem .22rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line);
         overflow-wrap: anywhere; }
th { font-weight: 600; } tbody th { font-weight: 400; color: var(--quiet); } td.n, th.n { text-align: right; }
td.n, th.n, td.s { white-space: nowrap; }
pre { background: var(--card); border: 1px solid var(--line); border-radius: .5rem; padding: .5rem .8rem; font-size: .9rem;
      overflow-x: auto; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(9.5rem, 1fr)); gap: .6rem; margin: .8rem 0 1rem; }
.tile { background: var(--card); border: 1px solid var(--line); border-radius: .5rem; padding: .5rem .8rem; }
.tile b { display: block; font-size: 1.35rem; line-height: 1.3; } .tile span { color: var(--quiet); font-size: .85rem; }
.pair > div { max-width: 34rem; } .pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 0 1.6rem; align-items: start; }
figure { margin: .6rem 0 1.2rem; break-inside: avoid; }
figcaption { color: var(--quiet); font-size: .88rem; }
svg { width: 100%; height: auto; display: block; }
svg text, svg tspan { font-family: inherit; fill: currentColor; }
@media (prefers-color-scheme: dark) { svg.plot image { filter: invert(1) hue-rotate(180deg); } }
svg.rose { max-width: 27rem; margin: 0 auto; } .ring { fill: none; stroke: currentColor; opacity: .25; }
.calm { fill: var(--paper); stroke: currentColor; stroke-opacity: .25; }
.halo { paint-order: stroke; stroke: var(--paper); stroke-width: 4px; }
.key { display: inline-block; width: .85em; height: .85em; border-radius: .15em; margin: 0 .35em 0 0;
       vertical-align: -.08em; } .keys span.item { margin-right: 1.1em; white-space: nowrap; }
footer { margin-top: 3rem; color: var(--quiet); font-size: .85rem; border-top: 1px solid var(--line); padding-top: .6rem; }
@page { size: A4; margin: 14mm; }
@media print {
  :root { color-scheme: light; --ink: #000; --quiet: #444; --paper: #fff; --card: #fff; --line: #bbb; --accent: #2f7fc1;
          --warn: #fff; }
  html { font-size: 12.5px; }
  body { max-width: none; padding: 0; font-size: 1rem; line-height: 1.4; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  h2.next { break-before: page; } h3 { break-after: avoid; } table, .tiles { break-inside: avoid; }
  h1 { font-size: 1.45rem; } .lead { font-size: 1.05rem; } h2 { margin-top: 1.2rem; } h3 { margin-top: 1rem; }
  .tiles { grid-template-columns: repeat(5, 1fr); } .tile b { font-size: 1.1rem; } svg.plot { max-height: 112mm; } svg.plot image { filter: none; }
  svg.rose { max-height: 80mm; } table.long { break-inside: auto; } .pair { grid-template-columns: 1fr 1fr; }
}
)css";

}  // namespace yuragi::daemon::tools::report

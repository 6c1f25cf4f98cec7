#!/usr/bin/env python3
"""Writes the guide as HTML, and a page with every key of a configuration.

usage: make_html.py FOLDER YURAGI [EMULATOR...]

FOLDER gets one page for each page of the guide, `keys.html` (what `yuragi describe` prints), and the style sheet. EMULATOR is the command that runs YURAGI if it is for another processor. The daemon serves the folder at /guide/.
"""
import html
import json
import pathlib
import re
import shutil
import subprocess
import sys

import markdown

GUIDE = pathlib.Path(__file__).resolve().parent
LINK = re.compile(r'<a href="([^"]+)">(.*?)</a>', re.DOTALL)
PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title} - Yuragi</title>
<link rel="stylesheet" href="guide.css">
</head>
<body>
<nav><a href="./">Guide</a> <a href="keys.html">All keys</a></nav>
<main>
{body}
</main>
</body>
</html>
"""


def link_in_html(match):
    """A link to a page of the guide goes to its HTML; of a file that only the sources have, its path is shown."""
    target, text = match.groups()
    page, _, anchor = target.partition("#")
    if "://" in target or not page:
        return match.group(0)
    if "/" not in page and page.endswith(".md"):
        name = "./" if page == "README.md" else page.removesuffix(".md") + ".html"
        return f'<a href="{name}{"#" + anchor if anchor else ""}">{text}</a>'
    path = (GUIDE / page).resolve().relative_to(GUIDE.parents[1])
    return f"{text} (<code>{path}</code> in the sources)"


def page_of(text):
    body = markdown.markdown(text, extensions=["tables", "toc", "sane_lists"])
    title = re.search(r"^# (.+)$", text, re.MULTILINE).group(1)
    return PAGE.format(title=html.escape(title), body=LINK.sub(link_in_html, body))


def shown(value):
    """As TOML has it."""
    return f"{value:g}" if isinstance(value, float) else json.dumps(value, ensure_ascii=False)


def values_of(parameter):
    """What a key may be, and what it is without a line in the file."""
    unit = f" {parameter['unit']}" if parameter["unit"] else ""
    if parameter["choices"]:
        allowed = ", ".join(shown(choice) for choice in parameter["choices"])
    else:
        limits = [f"{word} {shown(parameter[bound])}" for word, bound in (("from", "min"), ("to", "max")) if parameter[bound] is not None]
        allowed = " ".join([{"integer": "whole number", "bool": "true or false"}.get(parameter["type"], parameter["type"]), *limits]) + unit
    without = parameter["left_out"] if parameter["default"] is None else shown(parameter["default"]) + unit
    return f"{html.escape(allowed)}<br>default: {html.escape(without or 'none')}"


def keys_page(tables):
    parts = ["<h1>Every key of a configuration</h1>",
             "<p>A configuration is a TOML file. Every key has a default, and an empty file is allowed. "
             "<code>yuragi check-config FILE</code> checks a file; <code>yuragi describe</code> prints this list.</p>"]
    for table in tables:
        rows = "".join(f"<tr><td><code>{key['name']}</code></td><td>{values_of(key)}</td><td>{html.escape(key['help'])}</td></tr>\n"
                       for key in table["parameters"])
        name = f"<code>{html.escape(table['table'])}</code> " if table["table"] else ""
        parts.append(f"<h2>{name}{html.escape(table['summary'])}</h2>\n<table>\n<thead><tr><th>key</th><th>value</th><th>meaning</th></tr></thead>\n"
                     f"<tbody>\n{rows}</tbody>\n</table>")
    return PAGE.format(title="Every key of a configuration", body="\n".join(parts))


def main(folder, *yuragi):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for page in GUIDE.glob("*.md"):
        name = "index" if page.stem == "README" else page.stem
        (folder / f"{name}.html").write_text(page_of(page.read_text(encoding="utf-8")), encoding="utf-8")
    program, *emulator = yuragi
    described = subprocess.run([*emulator, program, "describe", "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout
    (folder / "keys.html").write_text(keys_page(json.loads(described)), encoding="utf-8")
    shutil.copyfile(GUIDE / "guide.css", folder / "guide.css")


if __name__ == "__main__":
    main(*sys.argv[1:])

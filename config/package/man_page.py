"""A manual page, man(7), of what a program prints by --help."""
import time


def escaped(text):
    text = text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq").replace("`", r"\(ga").replace("^", r"\(ha") \
        .replace("~", r"\(ti")
    return r"\&" + text if text.startswith(".") else text


def literal(lines):
    return [".nf", *[escaped(line) for line in lines], ".fi"]


def of_command(command):
    lines = []
    for title, entries in command.groups:
        lines += [".PP", rf"\fI{escaped(title)}\fR"]
        for term, text in entries:
            lines += [".TP", rf"\fB{escaped(term)}\fR", escaped(text) or r"\&"]
    if command.footer:
        lines += [".PP", *literal(command.footer)]
    return lines


def man_page(top, version, epoch_s):
    """The page of a program (Help) as text. Its date is that of the sources."""
    date = time.strftime("%Y-%m-%d", time.gmtime(epoch_s))
    short = top.description.removeprefix("Yuragi: ").split(". ")[0].rstrip(".")
    lines = [f'.TH {top.name.upper()} 1 "{date}" "{version}" "User Commands"',
             ".SH NAME", escaped(f"{top.name} - {short}"),
             ".SH SYNOPSIS", rf"\fB{escaped(top.usage)}\fR",
             ".SH DESCRIPTION", escaped(top.description), *of_command(top)]
    if top.commands:
        lines.append(".SH COMMANDS")
        for command in list(top.walk())[1:]:
            lines += [f'.SS "{escaped(command.usage)}"', escaped(command.description), *of_command(command)]
    if top.name == "yuragi":
        lines += [".SH FILES", ".TP", r"\fI/etc/yuragi/yuragi.toml\fR", "the configuration of the service",
                  ".TP", r"\fI/var/lib/yuragi\fR", "its recording, its reports, what it remembers of the site"]
    return "\n".join(lines) + "\n"

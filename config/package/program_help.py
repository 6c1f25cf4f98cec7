"""Reads what a program prints of itself by --help, through all of its subcommands, as CLI11 prints it."""
import os
import re
import subprocess

ENTRY = re.compile(r"^  (?P<term>\S.*?)(?:\s{2,}(?P<text>\S.*))?$")
CONTINUED = re.compile(r"^ {8,}(?P<text>\S.*)$")
GROUP = re.compile(r"^(?P<title>\S.*):$")
SPELLING = re.compile(r"(?:^|,|\s)(--?[a-zA-Z][\w-]*)")
CHOICES = re.compile(r"(?P<option>[^:]*):\{(?P<values>[^{}]+)\}")
COMMANDS = "Subcommands"
OWN_GROUPS = {"Options", "Positionals", COMMANDS}  # CLI11's; others are groups where options follow, and else a footer


class Program:
    """A program that was built. `emulator`: the words of the command that runs it on this machine, if it is for another processor."""

    def __init__(self, path, emulator=()):
        self.name = os.path.basename(path)
        self.command = [*emulator, path]

    def output(self, *words):
        return subprocess.run([*self.command, *words], check=True, stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True).stdout


class Help:
    """One command: what it is, how it is called, groups of (term, text), what is said below them, its subcommands."""

    def __init__(self, program, words=()):
        self.name = " ".join([program.name, *words])
        text = program.output(*words, "--help")
        description, _, rest = text.partition("Usage:")
        usage, _, rest = rest.partition("\n")
        self.description = " ".join(description.split())
        self.usage = usage.strip()
        self.groups = []
        self.footer = self.read_groups(rest.splitlines())
        names = [term for title, entries in self.groups if title == COMMANDS for term, _ in entries]
        self.commands = [Help(program, [*words, name]) for name in names]

    def read_groups(self, lines):
        """Answers the lines after the last group."""
        for at, line in enumerate(lines):
            group, entry, continued = GROUP.match(line), ENTRY.match(line), CONTINUED.match(line)
            if group and (group["title"] in OWN_GROUPS or (at + 1 < len(lines) and lines[at + 1].startswith("  -"))):
                self.groups.append((group["title"], []))
            elif line and at > 0 and not lines[at - 1]:
                return lines[at:]
            elif continued and self.groups and self.groups[-1][1]:
                term, text = self.groups[-1][1].pop()
                self.groups[-1][1].append((term, f"{text} {continued['text']}".strip()))
            elif entry and self.groups:
                self.groups[-1][1].append((entry["term"], entry["text"] or ""))
        return []

    def terms(self):
        return [term for title, entries in self.groups if title != COMMANDS for term, _ in entries]

    def options(self):
        """Every option's spellings: -c, --config, ..."""
        return sorted({word for term in self.terms() for word in SPELLING.findall(term)})

    def choices(self):
        """{spelling: values} of the options that have values to choose from: "--dims INT:{1,2,3}=2"."""
        found = [CHOICES.match(term) for term in self.terms()]
        return {word: match["values"].split(",") for match in found if match for word in SPELLING.findall(match["option"])}

    def walk(self):
        yield self
        for command in self.commands:
            yield from command.walk()

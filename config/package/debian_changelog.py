"""CHANGELOG.md as a Debian changelog: an entry for each release; what is not released yet belongs to the version that is built."""
import email.utils
import re
import textwrap

RELEASE = re.compile(r"^## (?P<version>\d[\w.]*)")


def debian_changelog(markdown, package_version, epoch_s, maintainer):
    """Entries, newest first, all with the date of the sources: the text is not to depend on when it is made."""
    entries = [(package_version, [])]
    for line in markdown.splitlines():
        release = RELEASE.match(line)
        if release and release["version"] != package_version:
            entries.append((release["version"], []))
        elif line.startswith("- "):
            entries[-1][1].append(line[2:])
        elif line.startswith("  ") and entries[-1][1]:
            entries[-1][1][-1] += " " + line.strip()
    signature = f" -- {maintainer}  {email.utils.formatdate(epoch_s)}"
    text = []
    for version, changes in entries:
        text += [f"yuragi ({version}) stable; urgency=medium", ""]
        for change in changes or ["See the repository."]:
            text += textwrap.wrap(change, 76, initial_indent="  * ", subsequent_indent="    ", break_long_words=False,
                                  break_on_hyphens=False)
        text += ["", signature, ""]
    return "\n".join(text)

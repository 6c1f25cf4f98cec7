"""A completion for bash of what a program prints of itself: its subcommands and options by --help, the values that an option has to
choose from, and the drivers by `sensors describe`; else names of files."""

SCRIPT = """\
# Completion of {name} for bash. Made from the program's own help.
_{function}() {{
    local current=${{COMP_WORDS[COMP_CWORD]}} path={name} word
    for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
        case "$path $word" in
            {paths}) path="$path $word" ;;
        esac
    done
    local words
    case "$path" in
{cases}
    esac
    case "$path ${{COMP_WORDS[COMP_CWORD-1]}}" in
{choices}
    esac
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
complete -o bashdefault -o default -F _{function} {name}
"""


def bash_completion(top, arguments):
    """The script of a program (Help) as text. `arguments`: {command: what its argument may be}."""
    cases, choices = [], []
    for command in top.walk():
        words = [*[sub.name.split()[-1] for sub in command.commands], *arguments.get(command.name, []), *command.options()]
        cases.append(f"        '{command.name}') words='{' '.join(words)}' ;;")
        for option, values in command.choices().items():
            choices.append(f"        '{command.name} {option}') words='{' '.join(values)}' ;;")
    paths = " | ".join(f"'{command.name}'" for command in list(top.walk())[1:]) or "''"
    return SCRIPT.format(name=top.name, function=top.name.replace("-", "_"), paths=paths, cases="\n".join(cases),
                         choices="\n".join(choices))

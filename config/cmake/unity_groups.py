#!/usr/bin/env python3
"""Which sources of a target may be compiled as one file.

In a unity build the unnamed namespaces of several sources become one, so two sources that declare the same name there cannot
stand in one file. This reads sources, finds those names, and divides each target's sources into groups without a clash. Functions
of the same name clash whatever their parameters: together they would be overloads, and a call could choose the other one.

    unity_groups.py LIST > unity_groups.cmake

LIST has a line for each target: its name, its folder and its sources, separated by tabs. Of each target with a clash the output
sets UNITY_BUILD_MODE to GROUP and UNITY_GROUP of its sources; all other targets stay as they are, one file each.
"""
import collections
import re
import sys

TOKEN = re.compile(r"""
    //[^\n]* | /\*.*?\*/                                          # comments
  | ^[ \t]*\#(?:[^\n\\]|\\.)*                                     # preprocessor lines
  | (?P<raw>R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)")                 # literals
  | (?P<literal>"(?:[^"\\\n]|\\.)*" | '(?:[^'\\\n]|\\.)+')
  | (?P<token>[A-Za-z_]\w* | [0-9](?:'?[\w.])* | :: | -> | [^\s\w])
""", re.VERBOSE | re.DOTALL | re.MULTILINE)
CLOSING = {"(": ")", "[": "]", "{": "}", "<": ">"}
IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
WITH_ARGUMENTS = {"alignas", "decltype", "noexcept", "requires", "__attribute__", "explicit"}
NO_DECLARATION = {"static_assert", "friend", "asm"}


def tokens_of(text):
    """The tokens of a C++ source, without comments and preprocessor lines; each literal is one token \"\"."""
    tokens = []
    for match in TOKEN.finditer(text):
        if match["token"]:
            tokens.append(match["token"])
        elif match["raw"] or match["literal"]:
            tokens.append('""')
    return tokens


def after_bracket(tokens, at):
    """The index behind the bracket that closes the one at `at`."""
    opening, closing, depth = tokens[at], CLOSING[tokens[at]], 0
    while at < len(tokens):
        if tokens[at] in ("(", "[", "{") and opening == "<":
            at = after_bracket(tokens, at)
            continue
        depth += (tokens[at] == opening) - (tokens[at] == closing)
        at += 1
        if depth == 0:
            break
    return at


def end_of_statement(tokens, at):
    """The index behind the next semicolon outside brackets."""
    while at < len(tokens) and tokens[at] != ";":
        at = after_bracket(tokens, at) if tokens[at] in ("(", "[", "{") else at + 1
    return at + 1


def read_type(tokens, at):
    """The names that `struct X {...};` or `enum {...};` at `at` declares, and where the next declaration begins; no names if
    the type is only named: `struct X* pointer`."""
    is_open_enum = tokens[at] == "enum" and tokens[at + 1] not in ("class", "struct")
    at += 1
    names = []
    while at < len(tokens) and tokens[at] not in ("{", ";", ":"):
        if tokens[at] in ("(", "[", "<"):
            at = after_bracket(tokens, at)
            continue
        if IDENTIFIER.fullmatch(tokens[at]) and tokens[at] not in ("final", "class", "struct", "alignas"):
            names.append(tokens[at])
        at += 1
    is_nested = "::" in tokens[max(0, at - 3):at]  # struct Outer::Inner {
    while at < len(tokens) and tokens[at] not in ("{", ";"):
        at += 1
    if is_open_enum and at < len(tokens) and tokens[at] == "{":
        body = tokens[at + 1:after_bracket(tokens, at) - 1]
        names += [name for name, before in zip(body, ["{"] + body) if before in ("{", ",") and IDENTIFIER.fullmatch(name)]
    return ([] if is_nested else names), end_of_statement(tokens, at)


def read_declaration(tokens, at):
    """The names that the declaration at `at` declares, and where the next one begins. A `using` is named with what it stands
    for, "Bytes = std :: string": it may be declared again."""
    while tokens[at] in ("template", "requires", "[", "inline", "static", "constexpr", "const", "extern"):
        if tokens[at] == "template":
            at = after_bracket(tokens, at + 1)
        elif tokens[at] == "[":
            at = after_bracket(tokens, at)
        elif tokens[at] == "requires" and tokens[at + 1] == "(":
            at = after_bracket(tokens, at + 1)
        else:
            at += 1
    first = tokens[at]
    if first in NO_DECLARATION or first == "namespace":
        return [], end_of_statement(tokens, at)
    if first == "using":
        end = end_of_statement(tokens, at)
        return ([" ".join(tokens[at + 1:end - 1])] if tokens[at + 2] == "=" else []), end
    if first in ("struct", "class", "union", "enum", "concept"):
        return read_type(tokens, at) if first != "concept" else ([tokens[at + 1]], end_of_statement(tokens, at))

    # A function or variables: the name is the identifier before the first ( = { [ or ; outside template arguments. With nothing
    # before it, it is a macro's: TEST(Suite, Name) {...}
    names = []
    name = None
    begin = at
    while at < len(tokens):
        token = tokens[at]
        if token == "operator":  # overloaded by the types of its operands
            while tokens[at] != "(" or tokens[at + 1] == ")" and tokens[at + 2] == "(":
                at += 1
            name = None
        elif token == "(" and tokens[at + 1] == "*":  # void (*name)(int)
            name = tokens[at + 2]
        elif token == "<":
            at = after_bracket(tokens, at)
            continue
        elif token in WITH_ARGUMENTS and tokens[at + 1] == "(":
            at = after_bracket(tokens, at + 1)
            continue
        elif token == "[" and tokens[at + 1] == "[":
            at = after_bracket(tokens, at)
            continue
        elif IDENTIFIER.fullmatch(token):
            is_member = tokens[at - 1] == "::" and tokens[at + 1] == "("  # void Outer::run() {...}
            name = None if is_member or at == begin else token
        if token in ("=", "{", "(", "[", ";", ",") or tokens[at] == "(":
            break
        at += 1
    if name:
        names.append(name)
    if at < len(tokens) and tokens[at] == "(":
        at = after_bracket(tokens, at)
        while at < len(tokens) and tokens[at] not in ("{", ";", "="):
            at = after_bracket(tokens, at) if tokens[at] in ("(", "[") else at + 1
        if at < len(tokens) and tokens[at] == "{":
            return names, after_bracket(tokens, at)
        return names, end_of_statement(tokens, at)
    while at < len(tokens) and tokens[at] != ";":  # double one = 1, other = 2;
        if tokens[at] in ("(", "[", "{", "<"):
            at = after_bracket(tokens, at)
        elif tokens[at] == ",":
            names.append(tokens[at + 1])
            at += 1
        else:
            at += 1
    return names, at + 1


def local_names(text):
    """What a source declares in unnamed namespaces: names as ("yuragi::", "clamp"), the namespaces around them first."""
    tokens = tokens_of(text)
    names = set()
    scopes = []  # the namespaces that are open; None is an unnamed one
    at = 0
    while at < len(tokens):
        if tokens[at] == "namespace" or tokens[at:at + 2] == ["inline", "namespace"]:
            opening = at
            while tokens[opening] not in ("{", ";", "="):
                opening += 1
            if tokens[opening] == "{":
                named = [token for token in tokens[at:opening] if token not in ("inline", "namespace", "::")]
                scopes.append("::".join(named) or None)
                at = opening + 1
                continue
        if tokens[at] == "}":
            if scopes:
                scopes.pop()
            at += 1
        elif tokens[at] == ";":
            at += 1
        elif tokens[at] == "extern" and tokens[at + 1:at + 3] == ['""', "{"]:
            at = after_bracket(tokens, at + 2)
        else:
            declared, at = read_declaration(tokens, at)
            if None in scopes:
                path = "".join(scope + "::" for scope in scopes if scope)
                names.update((path, name) for name in declared)
    return names


def groups_of(targets, names):
    """{source: group} of sources in targets, [(target, [source])], so that no group of a target declares a name twice."""
    others = collections.defaultdict(set)  # the sources that clash with each
    for _, sources in targets:
        declaring = collections.defaultdict(list)
        for source in sources:
            for scope, declared in names[source]:
                declaring[scope, declared.split()[0]].append((source, declared))
        for clashing in declaring.values():
            for source, declared in clashing:
                others[source].update(other for other, again in clashing
                                      if other != source and not declared == again != again.split()[0])
    groups = {}
    for source in dict.fromkeys(source for _, sources in targets for source in sources):
        taken = {groups.get(other) for other in others[source]}
        groups[source] = next(group for group in range(len(taken) + 1) if group not in taken)
    return groups


def main():
    folders = collections.defaultdict(list)
    with open(sys.argv[1], encoding="utf-8") as listed:
        for line in listed.read().splitlines():
            target, folder, *sources = line.split("\t")
            folders[folder].append((target, sources))
    names = {}
    for targets in folders.values():
        for _, sources in targets:
            for source in sources:
                if source not in names:
                    with open(source, encoding="utf-8") as text:
                        names[source] = local_names(text.read())
    for targets in folders.values():
        groups = groups_of(targets, names)
        for target, sources in targets:
            if all(groups[source] == 0 for source in sources):
                continue
            print(f"set_target_properties({target} PROPERTIES UNITY_BUILD_MODE GROUP)")
            for source in sources:
                print(f'set_source_files_properties("{source}" TARGET_DIRECTORY {target} PROPERTIES UNITY_GROUP {groups[source]})')


if __name__ == "__main__":
    main()

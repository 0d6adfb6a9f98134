"""Reads the --help texts of meshwind (the form of CLI11) into records."""
import dataclasses
import os
import re
import subprocess

INDENT = 30  # column at which descriptions start


@dataclasses.dataclass
class Option:
    """A positional argument or an option."""
    names: list     # ["-o", "--out"]; of a positional argument its one name
    kind: str       # FILE, MM, TEXT ...; empty: a flag
    choices: list   # the values that are taken, where they are listed
    span: str       # further bounds in words
    default: str    # empty: none is told
    required: bool
    relation: str   # what it needs or excludes, in words
    meaning: str
    group: str      # heading that it stands under


@dataclasses.dataclass
class Command:
    """The help of one command."""
    path: tuple     # () for the program itself, ("study", "mesh-size") for a command
    about: str
    usage: str
    options: list
    commands: list  # (name, meaning)
    more: str       # what stands below


def _entry(name, meaning, group):
    whole = re.fullmatch(
        r"(?P<names>\S+)(?: (?P<value>.*?))??(?P<required> REQUIRED)?(?: \.\.\.)?(?: Needs: (?P<needs>.*?))?"
        r"(?: Excludes: (?P<excludes>.*))?", name)
    names = [re.sub(r"\{.*\}$", "", n) for n in whole["names"].split(",")]
    value = whole["value"] or ""
    kind, _, default = value.partition("=")
    kind, _, bounds = kind.partition(":")
    choices = bounds[1:-1].split(",") if bounds.startswith("{") else []
    span = ""
    if between := re.fullmatch(r"(?:INT|FLOAT) in \[([\d.]+) - ([\d.]+)\]", bounds):
        span = f"{between[1]} to {between[2]}"
    elif bounds == "POSITIVE":
        span = "above 0"
    elif bounds == "NONNEGATIVE":
        span = "0 or more"
    elif bounds and not choices:
        raise ValueError(f"{name}: what does '{bounds}' bound?")
    if told := re.search(r" \[([^\]]*)\]$", meaning):
        default, meaning = default or told[1], meaning[:told.start()]
    relation = [f"{word} {' '.join(rest.split())}" for word, rest in
                (("needs", whole["needs"]), ("not with", whole["excludes"])) if rest]
    return Option(names, kind, choices, span, default.strip("[]"), bool(whole["required"]), "; ".join(relation),
                  meaning, group)


def _parse(path, text):
    head, usage, rest = re.fullmatch(r"(.*?)\nUsage: ([^\n]*)\n(.*)", text, re.S).groups()
    command = Command(path, head, usage, [], [], "")
    lines = rest.split("\n")
    group = None
    at = 0
    while at < len(lines):
        line = lines[at]
        at += 1
        if re.fullmatch(r"[A-Z][A-Za-z ]*:", line) and line != "Examples:" and lines[at].startswith("  ") and \
                not line.startswith("Exit"):
            group = line[:-1]
            continue
        if not line:
            continue
        if group is None or not line.startswith("  "):
            command.more = "\n".join(lines[at - 1:]).strip("\n")
            break
        # A long name has its meaning in the next line.
        if at < len(lines) and lines[at].startswith(" " * INDENT):
            name, meaning = line.strip(), lines[at].strip()
            at += 1
        else:
            name, meaning = line[:INDENT].strip(), line[INDENT:].strip()
        if group == "Subcommands":
            command.commands.append((name, meaning))
        else:
            command.options.append(_entry(name, meaning, group))
    return command


def read_commands(program):
    """All commands, the program itself first, each before its own commands; and the version."""
    environment = dict(os.environ, LC_ALL="C", COLUMNS="80")

    def said(*arguments):
        return subprocess.run([str(program), *arguments], check=True, capture_output=True, text=True,
                              env=environment).stdout

    found = []

    def visit(path):
        command = _parse(path, said(*path, "--help"))
        found.append(command)
        for name, _ in command.commands:
            visit((*path, name))

    visit(())
    return found, said("--version").split()[1]

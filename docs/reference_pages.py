"""Command-line reference, manual page and completion of bash from the records of reference_help.py."""
import re
import textwrap

MADE = "made by docs/make_reference.py; do not edit"
COMMON = "Options of every command"


def _value(option):
    return "|".join(option.choices) or option.kind


def wrapped(text):
    """Lines of at most 120 columns."""
    return textwrap.wrap(" ".join(text.split()), 120, break_long_words=False, break_on_hyphens=False)


def _paragraphs(text):
    return [p for p in re.split(r"\n\s*\n", text) if p.strip()]


def _is_common(paragraph):
    return paragraph.startswith(COMMON)


def _cell(text):
    return text.replace("|", "\\|")


def _table(options):
    lines = ["| option | value | default | meaning |", "|---|---|---|---|"]
    for o in options:
        notes = "; ".join(n for n in ("required" if o.required else "", o.span, o.relation) if n)
        value = " ".join(f"`{c}`" for c in o.choices) or (f"`{o.kind}`" if o.kind else "")
        lines.append("| " + " | ".join([
            ", ".join(f"`{n}`" for n in o.names), value, f"`{o.default}`" if o.default else "",
            _cell(o.meaning + (f" ({notes})" if notes else ""))]) + " |")
    return lines


def _listing(paragraph):
    return ["", "    " + paragraph.replace("\n", "\n    ")]


def _anchor(path):
    return "-".join(("meshwind", *path))


def commands_page(commands):
    """docs/reference/commands.md"""
    out = [f"<!-- {MADE} -->", "# Command line", ""]
    main = commands[0]
    out += wrapped(main.about) + ["", "| command | |", "|---|---|"]
    for c in commands[1:]:
        out.append(f"| [`{' '.join(('meshwind', *c.path))}`](#{_anchor(c.path)}) | {_cell(c.about)} |")
    out += [""] + wrapped("Value names stand for units: `MM` mm, `DEG` degrees, `MM/S` mm/s, `GPA` and `MPA`, `TEX` g/km, "
                          "`RATIO` a plain number. Messages with exit code 2 are listed in [errors](../errors.md).")
    for c in commands:
        out += ["", f"## {' '.join(('meshwind', *c.path))}", ""]
        if c.path:
            out += [c.about[0].upper() + c.about[1:] + ".", ""]
        out += [f"    {c.usage}"]
        groups = []
        for o in c.options:
            if o.group not in groups:
                groups.append(o.group)
        for group in groups:
            shown = [o for o in c.options if o.group == group and "--help" not in o.names]
            if not shown:
                continue
            out += ["", f"{group}:", ""] + _table(shown)
        for p in _paragraphs(c.more):
            if _is_common(p):
                continue
            if p.startswith(("Examples:", "Exit codes:")):
                head, body = p.split("\n", 1)
                out += ["", head] + _listing(re.sub(r"^  ", "", body, flags=re.M))
            else:
                out += [""] + wrapped(p)
    return "\n".join(out) + "\n"


# ---- manual page

def _roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga")
    return re.sub(r"^([.])", r"\\&\1", text, flags=re.M)


def _roff_option(o):
    what = ", ".join(f"\\fB{_roff(n)}\\fR" for n in o.names)
    if value := _value(o):
        what += f" \\fI{_roff(value)}\\fR"
    notes = "; ".join(n for n in ("required" if o.required else "", o.span, o.relation,
                                  f"default {o.default}" if o.default else "") if n)
    return [".TP", what, _roff(o.meaning[0].upper() + o.meaning[1:] + (f" ({notes})" if notes else "") + ".")]


def _roff_more(text):
    out = []
    for p in _paragraphs(text):
        if _is_common(p) or p.startswith("Exit codes:"):
            continue
        if p.startswith("Examples:"):
            out += [".PP", "Examples:", ".PP", ".nf", ".RS 4"]
            out += [_roff(re.sub(r"^  ", "", line)) for line in p.split("\n")[1:]] + [".RE", ".fi"]
        else:
            out += [".PP"] + _roff(p).split("\n")
    return out


def manual_page(commands, version):
    """docs/meshwind.1. No date, so that the same sources give the same page."""
    main = commands[0]
    out = [f'.\\" {MADE}', f'.TH MESHWIND 1 "" "meshwind {version}" "User Commands"', ".SH NAME",
           "meshwind \\- filament winding on triangulated mandrels", ".SH SYNOPSIS"]
    shown = [c for c in commands if not c.commands or not c.path]
    for number, c in enumerate(shown):
        usage = re.sub(r"\[SUBCOMMAND\]", "", c.usage).split()
        if number:
            out.append(".br")
        words = len(("meshwind", *c.path))
        out.append("\\fB" + _roff(" ".join(usage[:words])) + "\\fR " + _roff(" ".join(usage[words:])))
    out += [".SH DESCRIPTION"] + _roff(main.about).split("\n")
    out += _roff_more(main.more)
    group = None
    for o in main.options:
        if o.group != group:
            group = o.group
            out.append({"Positionals": ".SH ARGUMENTS", "Options": ".SH OPTIONS"}.get(group, f".SS {group}"))
        out += _roff_option(o)
    out.append(".SH COMMANDS")
    for c in commands[1:]:
        out += [f'.SS "{_roff(" ".join(("meshwind", *c.path)))}"', _roff(c.about[0].upper() + c.about[1:] + ".")]
        for o in c.options:
            if "--help" not in o.names:
                out += _roff_option(o)
        out += _roff_more(c.more)
    out.append(".SH EXIT STATUS")
    for p in _paragraphs(main.more):
        if p.startswith("Exit codes:"):
            for line in p.split("\n")[1:]:
                code, words = line.split(None, 1)
                out += [".TP", f"\\fB{code}\\fR", _roff(words[0].upper() + words[1:] + ".")]
    out += [".SH ENVIRONMENT", ".TP", "\\fBMESHWIND_HOME\\fR",
            "Folder with data and machines in which bare names are looked up.",
            ".SH FILES", ".TP", "\\fIprogram.ngc\\fR",
            "The program for the controller; the ending depends on its language.", ".TP", "\\fIreport.html\\fR",
            "A page for the browser that shows plan, motion and checks.", ".TP", "\\fIreport.json\\fR",
            "Everything that was found, with the limit and the worst value of each check.", ".PP",
            "The pages in docs of the sources describe all files, jobs and machines."]
    return "\n".join(out) + "\n"


# ---- bash

def _kind_of_file(path, o):
    """What files an argument takes: mesh, machine, job, table, json, program, shown, file, folder."""
    name, kind = o.names[-1], o.kind
    if kind == "DIR":
        return "folder"
    if kind not in ("FILE", "NAME"):
        return ""
    by_name = {"mandrel": "mesh", "--mandrel": "mesh", "--machine": "machine", "--job": "job",
               "--profile": "profile", "points": "table",
               "axis": "axis", "file": "json", "program": "program", "what": "shown"}
    if name == "--out" and path == ("show",):
        return ""
    if name == "--out":
        return "table" if path == ("trace",) else "mesh"
    return by_name.get(name, "")


def bash_completion(commands):
    """cli/meshwind.bash: tables, and the functions of _BASH."""
    common = [o for o in commands[0].options if o.group == COMMON]
    words, takes, first = [], [], []
    for c in commands:
        key = " ".join(c.path)
        options = [n for o in c.options for n in o.names if n.startswith("-") and o.group != COMMON]
        words.append(f"    [{key or '-'}]='{' '.join(options + [n for n, _ in c.commands])}'")
        for o in c.options:
            if not o.kind and not o.choices:
                continue
            what = " ".join(o.choices) or _kind_of_file(c.path, o)
            if o.names == ["--mandrel"] and c.path == ("study", "mesh-size"):
                what = "mesh cylinder torus ellipsoid tee"
            for n in o.names:
                if o.group == COMMON:
                    takes.append(f"    [* {n}]='{what or '-'}'")
                elif n.startswith("-"):
                    takes.append(f"    [{key or '-'} {n}]='{what or '-'}'")
                else:
                    first.append(f"    [{key or '-'}]='{what}'")
    own = " ".join(n for o in common for n in o.names)
    return (_BASH.replace("@MADE@", MADE).replace("@COMMON@", own).replace("@WORDS@", "\n".join(words))
            .replace("@TAKES@", "\n".join(takes)).replace("@FIRST@", "\n".join(first)))


_BASH = r'''# Completion of meshwind for bash; @MADE@
# shellcheck shell=bash disable=SC2207

# Options of every command.
_meshwind_common='@COMMON@'
# Options and commands by command; - is the program itself.
declare -gA _meshwind_words=(
@WORDS@
)
# What an option takes: words, or mesh, machine, job, json, table, axis, program, shown, folder, or - for anything else.
declare -gA _meshwind_takes=(
@TAKES@
)
# What a command takes besides options.
declare -gA _meshwind_first=(
@FIRST@
)

# The folder that bare names are looked up in: $MESHWIND_HOME, the checkout, or the installation.
_meshwind_home() {
    local program folder
    if [[ -n ${MESHWIND_HOME-} ]]; then
        printf '%s\n' "$MESHWIND_HOME"
        return
    fi
    program=$(readlink -f -- "$(type -P "$1")" 2>/dev/null) || return 0
    for folder in "${program%/*}" "${program%/bin/*}/share/meshwind" "${program%/build/*}"; do
        if [[ -d $folder/machines ]]; then
            printf '%s\n' "$folder"
            return
        fi
    done
}

# _meshwind_named CURRENT PATTERN FOLDER...: names of files of the home's folders.
_meshwind_named() {
    local current=$1 pattern=$2 folder file
    shift 2
    for folder in "$@"; do
        for file in "$home/$folder"/$pattern; do
            [[ ! -f $file || ${file##*/} != "$current"* ]] || COMPREPLY+=("${file##*/}")
        done
    done
}

# _meshwind_files CURRENT ENDING...: files with these endings, and folders.
_meshwind_files() {
    local current=$1 file ending
    shift
    while IFS= read -r file; do
        if [[ -d $file ]]; then
            COMPREPLY+=("$file")
            continue
        fi
        for ending in "$@"; do
            [[ $file != *."$ending" ]] || COMPREPLY+=("$file")
        done
    done < <(compgen -f -- "$current")
    compopt -o filenames 2>/dev/null
}

_meshwind_fill() {
    local what=$1 current=$2
    case ${what%% *} in
    mesh)
        _meshwind_files "$current" stl STL obj ply off csv dxf
        _meshwind_named "$current" '*.stl' data data/meshes
        _meshwind_named "$current" '*.obj' data/meshes
        [[ $what != *' '* ]] || COMPREPLY+=($(compgen -W "${what#* }" -- "$current"))
        ;;
    machine | json)
        _meshwind_files "$current" json
        _meshwind_named "$current" '*.json' machines
        ;;
    profile)
        _meshwind_files "$current" json
        _meshwind_named "$current" '*.json' data/profiles
        ;;
    job) _meshwind_files "$current" json ;;
    table) _meshwind_files "$current" csv ;;
    axis)
        _meshwind_files "$current" csv stl obj ply off
        _meshwind_named "$current" '*_axis.csv' data
        ;;
    program) _meshwind_files "$current" ngc nc mpf gcode pulses mod src ;;
    shown) _meshwind_files "$current" stl STL obj ply off csv dxf ngc nc mpf gcode pulses mod src ;;
    folder)
        COMPREPLY+=($(compgen -d -- "$current"))
        compopt -o filenames 2>/dev/null
        ;;
    -) ;;
    *) COMPREPLY+=($(compgen -W "$what" -- "$current")) ;;
    esac
}

_meshwind() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} home
    local command=- longer word at waits=''
    COMPREPLY=()
    home=$(_meshwind_home "${COMP_WORDS[0]}")
    # --option=value comes as three words.
    if [[ $current == = ]]; then
        current=''
    elif [[ $previous == = ]]; then
        previous=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    for ((at = 1; at < COMP_CWORD; ++at)); do
        word=${COMP_WORDS[at]}
        if [[ -n $waits ]]; then
            waits=''
            continue
        fi
        [[ $word != = ]] || continue
        if [[ $word == -* ]]; then
            waits=${_meshwind_takes[$command $word]-}${_meshwind_takes[* $word]-}
            [[ ${COMP_WORDS[at + 1]-} != = ]] || waits=''
            continue
        fi
        longer=$word
        [[ $command == - ]] || longer="$command $word"
        [[ -z ${_meshwind_words[$longer]-} ]] || command=$longer
    done
    if [[ $previous == -* ]]; then
        # What a command takes, its parent takes too: meshwind make tee --edge 4.
        for word in "$command" "${command% *}" '*'; do
            if [[ -n ${_meshwind_takes[$word $previous]-} ]]; then
                _meshwind_fill "${_meshwind_takes[$word $previous]}" "$current"
                return
            fi
        done
    fi
    if [[ $current == -* ]]; then
        word="${_meshwind_words[$command]} $_meshwind_common"
        [[ $command != *' '* ]] || word+=" ${_meshwind_words[${command% *}]}"
        COMPREPLY=($(compgen -W "$(printf '%s\n' "${word// /$'\n'}" | grep -e '^-')" -- "$current"))
        return
    fi
    word=${_meshwind_words[$command]}
    COMPREPLY=($(compgen -W "$(printf '%s\n' "${word// /$'\n'}" | grep -v -e '^-')" -- "$current"))
    [[ -z ${_meshwind_first[$command]-} ]] || _meshwind_fill "${_meshwind_first[$command]}" "$current"
}

complete -F _meshwind meshwind ./meshwind
'''

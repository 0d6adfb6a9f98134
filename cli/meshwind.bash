# Completion of meshwind for bash; made by docs/make_reference.py; do not edit
# shellcheck shell=bash disable=SC2207

# Options of every command.
_meshwind_common='--threads --seed --units --json --verbose --quiet --force'
# Options and commands by command; - is the program itself.
declare -gA _meshwind_words=(
    [-]='-h --help --version --machine --job --profile --set -o --out --effort --png --png-size --png-colour wind post verify resume dry-run repeat show inspect make trace machines profiles validate carry design study export strength'
    [wind]='-h --help --machine --job --profile --set -o --out --effort --png --png-size --png-colour'
    [post]='-h --help --mandrel --machine --job --profile --set --frame --within --circuits --turn --smooth -o --out --png --png-size --png-colour'
    [verify]='-h --help --mandrel --machine --job --profile --set --tie-on --frame --plan -o --out'
    [resume]='-h --help --mandrel --machine --job --profile --set --tie-on --frame --block --line -o --out'
    [dry-run]='-h --help --mandrel --machine --job --profile --set --tie-on --frame --clearance -o --out'
    [repeat]='-h --help --mandrel --machine --profile --set -o --out --png --png-size --png-colour'
    [show]='-h --help --mandrel --machine -o --out'
    [inspect]='-h --help --job --profile --set --refine -o --out --page'
    [make]='-h --help -o --out --edge --irregular --solid --wall cylinder cone vessel isotensoid elbow tee wye cross combination frame torus ellipsoid'
    [make cylinder]='-h --help --radius --length'
    [make cone]='-h --help --radius1 --radius2 --length'
    [make vessel]='-h --help --radius --cylinder-length --dome-height --opening-radius --upper-opening-radius'
    [make isotensoid]='-h --help --radius --cylinder-length --opening-radius --ke --design-radius'
    [make elbow]='-h --help --pipe-radius --bend-radius --angle --leg1 --leg2'
    [make tee]='-h --help --run-radius --branch-radius --blend-radius --run-length --branch-length --lean'
    [make wye]='-h --help --pipe-radius --blend-radius --stem-length --arm-length --angle'
    [make cross]='-h --help --pipe-radius --blend-radius --run-length --branch-length'
    [make combination]='-h --help --radius1 --length1 --cone-length --radius2 --length2 --dome-height --opening-radius'
    [make frame]='-h --help --pipe-radius --bend-radius --angle --leg1 --leg2'
    [make torus]='-h --help --ring-radius --tube-radius --angle'
    [make ellipsoid]='-h --help --equator-radius --pole-radius'
    [trace]='-h --help --start --direction --angle --to --lambda --length --method --frame -o --out'
    [machines]='-h --help'
    [profiles]='-h --help'
    [validate]='-h --help --schema'
    [carry]='-h --help --from-end --bend-turn --machine --tool --speed --tolerance --tolerance-angle --tube-radius --ring-radius --ring-distance --clearance --angle --tows --tow-width --passes --at-once --spool-radius --angle-tolerance --friction --tow-tex --name -o --out'
    [design]='-h --help vessel'
    [design vessel]='-h --help --radius --opening --length --ke --e1 --e2 --nu12 --design-radius --angles --band --thickness --density --wall --pressure --strength -o --out'
    [study]='-h --help mesh-size cases merge'
    [study mesh-size]='-h --help --mandrel --radius --edges --lambda --paths --length --free-length --irregular --regular --timing -o --out'
    [study cases]='-h --help -o --out --row --effort'
    [study merge]='-h --help -o --out --left'
    [export]='-h --help fe'
    [export fe]='-h --help --material --pressure --axial --moment --rims --merge --plies --format -o --out'
    [strength]='-h --help --material --pressure --axial --moment --rims --merge --plies -o --out'
)
# What an option takes: words, or mesh, machine, job, json, table, axis, program, shown, folder, or - for anything else.
declare -gA _meshwind_takes=(
    [- --machine]='machine'
    [- --job]='job'
    [- --profile]='profile'
    [- --set]='-'
    [- -o]='folder'
    [- --out]='folder'
    [- --effort]='-'
    [- --png]='-'
    [- --png-size]='-'
    [- --png-colour]='course layers slip angle'
    [* --threads]='-'
    [* --seed]='-'
    [* --units]='auto um mm cm m in'
    [wind --machine]='machine'
    [wind --job]='job'
    [wind --profile]='profile'
    [wind --set]='-'
    [wind -o]='folder'
    [wind --out]='folder'
    [wind --effort]='-'
    [wind --png]='-'
    [wind --png-size]='-'
    [wind --png-colour]='course layers slip angle'
    [post --mandrel]='mesh'
    [post --machine]='machine'
    [post --job]='job'
    [post --profile]='profile'
    [post --set]='-'
    [post --frame]='file mandrel'
    [post --within]='-'
    [post --circuits]='-'
    [post --turn]='-'
    [post --smooth]='-'
    [post -o]='folder'
    [post --out]='folder'
    [post --png]='-'
    [post --png-size]='-'
    [post --png-colour]='course layers slip angle'
    [verify --mandrel]='mesh'
    [verify --machine]='machine'
    [verify --job]='job'
    [verify --profile]='profile'
    [verify --set]='-'
    [verify --tie-on]='-'
    [verify --frame]='file mandrel'
    [verify --plan]='folder'
    [verify -o]='folder'
    [verify --out]='folder'
    [resume --mandrel]='mesh'
    [resume --machine]='machine'
    [resume --job]='job'
    [resume --profile]='profile'
    [resume --set]='-'
    [resume --tie-on]='-'
    [resume --frame]='file mandrel'
    [resume --block]='-'
    [resume --line]='-'
    [resume -o]='mesh'
    [resume --out]='mesh'
    [dry-run --mandrel]='mesh'
    [dry-run --machine]='machine'
    [dry-run --job]='job'
    [dry-run --profile]='profile'
    [dry-run --set]='-'
    [dry-run --tie-on]='-'
    [dry-run --frame]='file mandrel'
    [dry-run --clearance]='-'
    [dry-run -o]='mesh'
    [dry-run --out]='mesh'
    [repeat --mandrel]='mesh'
    [repeat --machine]='machine'
    [repeat --profile]='profile'
    [repeat --set]='-'
    [repeat -o]='folder'
    [repeat --out]='folder'
    [repeat --png]='-'
    [repeat --png-size]='-'
    [repeat --png-colour]='course layers slip angle'
    [show --mandrel]='mesh'
    [show --machine]='machine'
    [show -o]='-'
    [show --out]='-'
    [inspect --job]='job'
    [inspect --profile]='profile'
    [inspect --set]='-'
    [inspect --refine]='-'
    [inspect -o]='mesh'
    [inspect --out]='mesh'
    [inspect --page]='-'
    [make -o]='mesh'
    [make --out]='mesh'
    [make --edge]='-'
    [make --wall]='-'
    [make cylinder --radius]='-'
    [make cylinder --length]='-'
    [make cone --radius1]='-'
    [make cone --radius2]='-'
    [make cone --length]='-'
    [make vessel --radius]='-'
    [make vessel --cylinder-length]='-'
    [make vessel --dome-height]='-'
    [make vessel --opening-radius]='-'
    [make vessel --upper-opening-radius]='-'
    [make isotensoid --radius]='-'
    [make isotensoid --cylinder-length]='-'
    [make isotensoid --opening-radius]='-'
    [make isotensoid --ke]='-'
    [make isotensoid --design-radius]='-'
    [make elbow --pipe-radius]='-'
    [make elbow --bend-radius]='-'
    [make elbow --angle]='-'
    [make elbow --leg1]='-'
    [make elbow --leg2]='-'
    [make tee --run-radius]='-'
    [make tee --branch-radius]='-'
    [make tee --blend-radius]='-'
    [make tee --run-length]='-'
    [make tee --branch-length]='-'
    [make tee --lean]='-'
    [make wye --pipe-radius]='-'
    [make wye --blend-radius]='-'
    [make wye --stem-length]='-'
    [make wye --arm-length]='-'
    [make wye --angle]='-'
    [make cross --pipe-radius]='-'
    [make cross --blend-radius]='-'
    [make cross --run-length]='-'
    [make cross --branch-length]='-'
    [make combination --radius1]='-'
    [make combination --length1]='-'
    [make combination --cone-length]='-'
    [make combination --radius2]='-'
    [make combination --length2]='-'
    [make combination --dome-height]='-'
    [make combination --opening-radius]='-'
    [make frame --pipe-radius]='-'
    [make frame --bend-radius]='-'
    [make frame --angle]='-'
    [make frame --leg1]='-'
    [make frame --leg2]='-'
    [make torus --ring-radius]='-'
    [make torus --tube-radius]='-'
    [make torus --angle]='-'
    [make ellipsoid --equator-radius]='-'
    [make ellipsoid --pole-radius]='-'
    [trace --start]='-'
    [trace --direction]='-'
    [trace --angle]='-'
    [trace --to]='-'
    [trace --lambda]='-'
    [trace --length]='-'
    [trace --method]='patches walk'
    [trace --frame]='mandrel file'
    [trace -o]='table'
    [trace --out]='table'
    [validate --schema]='job machine report layup'
    [carry --bend-turn]='-'
    [carry --machine]='machine'
    [carry --tool]='-'
    [carry --speed]='-'
    [carry --tolerance]='-'
    [carry --tolerance-angle]='-'
    [carry --tube-radius]='-'
    [carry --ring-radius]='-'
    [carry --ring-distance]='-'
    [carry --clearance]='-'
    [carry --angle]='-'
    [carry --tows]='-'
    [carry --tow-width]='-'
    [carry --passes]='-'
    [carry --spool-radius]='-'
    [carry --angle-tolerance]='-'
    [carry --friction]='-'
    [carry --tow-tex]='-'
    [carry --name]='-'
    [carry -o]='folder'
    [carry --out]='folder'
    [design vessel --radius]='-'
    [design vessel --opening]='-'
    [design vessel --length]='-'
    [design vessel --ke]='-'
    [design vessel --e1]='-'
    [design vessel --e2]='-'
    [design vessel --nu12]='-'
    [design vessel --design-radius]='-'
    [design vessel --angles]='-'
    [design vessel --band]='-'
    [design vessel --thickness]='-'
    [design vessel --density]='-'
    [design vessel --wall]='-'
    [design vessel --pressure]='-'
    [design vessel --strength]='-'
    [design vessel -o]='folder'
    [design vessel --out]='folder'
    [study mesh-size --mandrel]='mesh cylinder torus ellipsoid tee'
    [study mesh-size --radius]='-'
    [study mesh-size --edges]='-'
    [study mesh-size --lambda]='-'
    [study mesh-size --paths]='-'
    [study mesh-size --length]='-'
    [study mesh-size --free-length]='-'
    [study mesh-size -o]='folder'
    [study mesh-size --out]='folder'
    [study cases -o]='folder'
    [study cases --out]='folder'
    [study cases --row]='-'
    [study cases --effort]='-'
    [study merge -o]='folder'
    [study merge --out]='folder'
    [export fe --material]='-'
    [export fe --pressure]='-'
    [export fe --axial]='-'
    [export fe --moment]='-'
    [export fe --rims]='-'
    [export fe --merge]='-'
    [export fe --plies]='-'
    [export fe --format]='calculix abaqus nastran'
    [export fe -o]='mesh'
    [export fe --out]='mesh'
    [strength --material]='-'
    [strength --pressure]='-'
    [strength --axial]='-'
    [strength --moment]='-'
    [strength --rims]='-'
    [strength --merge]='-'
    [strength --plies]='-'
    [strength -o]='folder'
    [strength --out]='folder'
)
# What a command takes besides options.
declare -gA _meshwind_first=(
    [-]='mesh'
    [wind]='mesh'
    [post]='table'
    [verify]='program'
    [resume]='program'
    [dry-run]='program'
    [repeat]='program'
    [show]='shown'
    [inspect]='mesh'
    [trace]='mesh'
    [validate]='json'
    [carry]='axis'
    [study cases]=''
    [study merge]=''
    [export fe]='folder'
    [strength]='folder'
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

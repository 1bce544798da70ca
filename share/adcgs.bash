# SPDX-License-Identifier: BSD-2-Clause
# Completion of the command lines of adcgs, for bash. It uses each program's own table of options, which `program --completion`
# prints (src/cli/completion.h).

# _adcgs_words WORD...: offer the words that begin with $_adcgs_stub, with $_adcgs_kept, the finished part of the word, in front.
_adcgs_words()
{
    local word
    for word; do
        [[ $word == "$_adcgs_stub"* ]] && COMPREPLY+=("$_adcgs_kept$word")
    done
}

_adcgs_files()
{
    compopt -o filenames 2>/dev/null
    local word
    while IFS= read -r word; do
        COMPREPLY+=("$_adcgs_kept$word")
    done < <(compgen -f -- "$_adcgs_stub")
}

# _adcgs_value KIND VALUE WORDS: complete the value of an option. VALUE is its name in the help: NAME=VALUE,... is a list of
# pairs.
_adcgs_value()
{
    local kind=$1 value=$2 words=$3 list
    [[ $words == - ]] && words=
    if [[ $value == *,... && $_adcgs_stub == *,* ]]; then
        _adcgs_kept+=${_adcgs_stub%,*},
        _adcgs_stub=${_adcgs_stub##*,}
    fi
    read -ra list <<<"$words"
    if [[ $value == *=* ]]; then
        compopt -o nospace 2>/dev/null
        list=("${list[@]/%/=}")
    fi
    _adcgs_words "${list[@]}"
    [[ $kind == file ]] && _adcgs_files
}

_adcgs()
{
    COMPREPLY=()
    # Split words at blanks: bash also splits them at = and :, and expects only the part after the last of these characters.
    local line=${COMP_LINE:0:COMP_POINT} word previous _adcgs_kept= _adcgs_stub
    word=${line##*[[:blank:]]}
    previous=${line%"$word"}
    previous=${previous%"${previous##*[![:blank:]]}"}
    previous=${previous##*[[:blank:]]}
    _adcgs_stub=$word
    if [[ $word == --*=* ]]; then
        previous=${word%%=*}
        _adcgs_kept=$previous=
        _adcgs_stub=${word#*=}
    fi
    local name letter kind value words help options=() found= verb=
    # adcgs VERB ... is completed as adcgs-VERB.
    [[ ${1##*/} == adcgs && $line =~ ^[^[:blank:]]+[[:blank:]]+([^-[:blank:]][^[:blank:]]*)[[:blank:]] ]] && verb=${BASH_REMATCH[1]}
    while IFS=$'\t' read -r name letter kind value words help; do
        [[ $name == - ]] || options+=("$name")
        if [[ $kind != flag && $previous == -?* && ($previous == "$name" || $previous == "$letter") ]]; then
            _adcgs_value "$kind" "$value" "$words"
            found=1
        elif [[ $name == - && -z $found ]]; then
            if [[ $word == -* ]]; then
                _adcgs_words "${options[@]}"
            elif [[ $kind == file ]]; then
                _adcgs_files
            elif [[ $words != - ]]; then
                _adcgs_words $words
            fi
        fi
    done < <("${1/#\~/$HOME}" $verb --completion 2>/dev/null)
    # Remove the front part, which bash does not replace.
    local current=${COMP_WORDS[COMP_CWORD]} i
    [[ $current == [=:] ]] && current=
    local behind=${word%"$current"}
    for i in "${!COMPREPLY[@]}"; do
        COMPREPLY[i]=${COMPREPLY[i]#"$behind"}
    done
}

complete -F _adcgs adcgs adcgs-check adcgs-conform adcgs-dec adcgs-demo-scene adcgs-enc adcgs-eval adcgs-import adcgs-info adcgs-join \
    adcgs-share adcgs-sweep

# SPDX-License-Identifier: BSD-2-Clause
# zsh -f offers.zsh FUNCTIONS LINE...: prints the completions that zsh offers at the end of each LINE: one output line each,
# sorted, separated by |. zsh also reads the completion functions of the folder FUNCTIONS.
zmodload zsh/zpty
folder=$1
shift
zpty shell zsh -f -i
zpty -w shell "PROMPT= PS2= fpath=(${(q)folder} \$fpath)
unsetopt zle_bracketed_paste prompt_sp
autoload -Uz compinit && compinit -D -u
zstyle ':completion:*' list-prompt ''
LISTMAX=100000
compadd()
{
    local -a matches
    [[ \${(M)argv:#-[OAD]} ]] || { builtin compadd -O matches \"\$@\"; seen+=(\$matches); }
    builtin compadd \"\$@\"
}
offer()
{
    seen=()
    _main_complete
    compstate[list]= compstate[insert]=
    print -r -- \"<\${(j:|:)\${(@ou)seen}}>\"
}
zle -C offer complete-word offer
bindkey '^T' offer
bindkey '^U' kill-whole-line
print ready''"
while zpty -r shell text && [[ $text != ready* ]]; do :; done
for line; do
    zpty -w -n shell "$line"$'\C-T'
    while zpty -r shell text '*'$'\n'; do
        [[ $text == *\<*\>* ]] && break
    done
    print -r -- "${${text##*<}%>*}"
    zpty -w -n shell $'\C-U'
done
zpty -d shell

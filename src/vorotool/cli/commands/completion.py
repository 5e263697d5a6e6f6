"""``vorotool completion``, and how shells ask what an argument can be: click's, with scripts of our own.

Those of click 8.1 offer all files, whatever is read, and in bash nothing after ``--option=``.
"""

from __future__ import annotations

import os
from typing import ClassVar

import click
from click.shell_completion import (
    BashComplete,
    CompletionItem,
    FishComplete,
    ShellComplete,
    ZshComplete,
    split_arg_string,
)

from vorotool.cli.command import Choice
from vorotool.jobs.terminal import print_text

VARIABLE = "_VOROTOOL_COMPLETE"
"""Set where a shell asks for candidates."""

_BASH = """\
# bash 4.4 or later: eval "$(vorotool completion bash)" in ~/.bashrc
%(complete_func)s() {
    local IFS=$'\\n' line kind value extension current="${COMP_WORDS[COMP_CWORD]}"
    [[ $current == = ]] && current=
    COMPREPLY=()
    while read -r line; do
        kind="${line%%%%,*}" value="${line#*,}"
        if [[ $kind == plain ]]; then
            COMPREPLY+=("$value")
            [[ $value == *= ]] && compopt -o nospace
            continue
        fi
        compopt -o filenames -o default
        mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$current")
        [[ $kind == path ]] && mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- "$current")
        value="$value|${value^^}"
        [[ $kind == file ]] && for extension in ${value//|/$'\\n'}; do
            mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X "!*.$extension" -- "$current")
        done
    done < <(COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD %(complete_var)s=bash_complete "$1" 2> /dev/null)
    return 0
}
complete -o nosort -F %(complete_func)s %(prog_name)s
"""

_ZSH = """\
#compdef %(prog_name)s
# zsh: eval "$(vorotool completion zsh)" in ~/.zshrc after compinit, or this text as a file _vorotool in $fpath
%(complete_func)s() {
    local -a response described names beginnings
    local kind value help
    response=("${(@f)$(COMP_WORDS="${(F)words}" COMP_CWORD=$((CURRENT - 1)) \\
        %(complete_var)s=zsh_complete $words[1] 2> /dev/null)}")
    [[ $PREFIX == --*=* ]] && compset -P 1 '*='
    for kind value help in $response; do
        case $kind in
            plain)
                if [[ $help != _ ]]; then described+=("${value//:/\\\\:}:$help")
                elif [[ $value == *= ]]; then beginnings+=("$value")
                else names+=("$value"); fi ;;
            dir) _files -/ ;;
            path) _files ;;
            file) _files -g "*.($value|${(U)value})" ;;
        esac
    done
    (( $#described )) && _describe -V -t vorotool argument described
    (( $#names )) && compadd -V vorotool -a names
    (( $#beginnings )) && compadd -V vorotool -S '' -a beginnings
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
    %(complete_func)s "$@"
else
    compdef %(complete_func)s %(prog_name)s
fi
"""

_FISH = """\
# fish: this text as a file ~/.config/fish/completions/vorotool.fish
function %(complete_func)s
    set -l current (commandline -ct)
    set -l before (string match -r -- '^--[^=]*=' "$current")
    set -l begun (string replace -r -- '^--[^=]*=' '' "$current")
    set -lx COMP_WORDS (commandline -cp)
    set -lx COMP_CWORD "$current"
    for line in (%(complete_var)s=fish_complete %(prog_name)s 2> /dev/null)
        set -l parts (string split -m 1 , -- $line)
        switch $parts[1]
            case plain
                echo "$before$parts[2]"
            case dir
                printf '%%s\\n' "$before"(__fish_complete_directories "$begun" '')
            case path
                printf '%%s\\n' "$before"(__fish_complete_path "$begun")
            case file
                set -l ending '(?:/|\\.(?:'$parts[2]'))(?:\\t.*)?$'
                printf '%%s\\n' "$before"(__fish_complete_path "$begun" | string match -eri -- $ending)
        end
    end
end
complete --no-files --keep-order --command %(prog_name)s --arguments '(%(complete_func)s)'
"""


class Bash(BashComplete):
    """Completion for bash, which takes ``=`` for a word of its own."""

    source_template: ClassVar[str] = _BASH

    def get_completion_args(self) -> tuple[list[str], str]:
        """Words before the one that is begun, and that one, with ``--option=value`` in one piece again."""
        words = split_arg_string(os.environ["COMP_WORDS"])
        last = int(os.environ["COMP_CWORD"])
        words = [*words[1 : last + 1], *[""] * (last >= len(words))]
        joined: list[str] = []
        for word in words:
            if joined and (word == "=" or joined[-1].endswith("=")):
                joined[-1] += word
            else:
                joined.append(word)
        return joined[:-1], joined[-1]


class Zsh(ZshComplete):
    """Completion for zsh."""

    source_template: ClassVar[str] = _ZSH

    def format_completion(self, item: CompletionItem[str]) -> str:
        """Three lines."""
        return f"{item.type}\n{item.value}\n{item.help or '_'}"


class Fish(FishComplete):
    """Completion for fish."""

    source_template: ClassVar[str] = _FISH


SHELLS: dict[str, type[ShellComplete]] = {"bash": Bash, "zsh": Zsh, "fish": Fish}


def complete(group: click.Command) -> int:
    """Let click answer a shell by these classes; the exit code."""
    from click.shell_completion import add_completion_class, shell_complete

    for name, shell in SHELLS.items():
        add_completion_class(shell, name)
    return shell_complete(group, {}, "vorotool", VARIABLE, os.environ[VARIABLE])


@click.command("completion")
@click.argument("shell", type=Choice(list(SHELLS)))
@click.pass_context
def command(context: click.Context, shell: str) -> None:
    """Print the script by which a shell completes options, their values, and files of the kinds that are read.

    \b
    Example:
      vorotool completion bash > vorotool.bash

    \b
    bash:  eval "$(vorotool completion bash)"      in ~/.bashrc
    zsh:   eval "$(vorotool completion zsh)"       in ~/.zshrc, after compinit
    fish:  vorotool completion fish > ~/.config/fish/completions/vorotool.fish
    """
    group = context.find_root().command
    text = ShellComplete.source(SHELLS[shell](group, {}, "vorotool", VARIABLE))
    print_text(text)

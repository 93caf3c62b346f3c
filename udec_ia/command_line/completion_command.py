"""The command that lets a shell complete commands, options and files.

eval "$(udec completion bash)"     in ~/.bashrc
eval "$(udec completion zsh)"      in ~/.zshrc
"""

from __future__ import annotations

import argparse
from functools import partial
from typing import Any

VERBS = ("completion",)
SHELLS = "bash", "zsh"
TEXT = "print what lets a shell complete the words of udec: bash or zsh"
FOR_ZSH = "autoload -U compinit bashcompinit && compinit && bashcompinit\n"
SCRIPT = """_udec() {{
    local typed="${{COMP_WORDS[COMP_CWORD]}}" words=""
    if [ "$COMP_CWORD" -eq 1 ]; then
        words="{verbs}"
    else
        case "${{COMP_WORDS[1]}}" in
{cases}        esac
    fi
    COMPREPLY=($(compgen -W "$words" -- "$typed") $(compgen -f -- "$typed"))
}}
complete -o filenames -F _udec udec
"""


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    completion = commands.add_parser("completion", help=TEXT, description=TEXT)
    completion.add_argument("shell", choices=SHELLS)
    completion.set_defaults(action=partial(_completion, commands))


def _completion(commands: Any, args: argparse.Namespace) -> int:
    print((FOR_ZSH if args.shell == "zsh" else "") + script(commands), end="")
    return 0


def script(commands: Any) -> str:
    """The lines that a shell executes. commands: all of `udec`, as argparse has them."""
    cases = "".join(
        f'            {verb}) words="{" ".join(_words(parser))}" ;;\n'
        for verb, parser in commands.choices.items()
    )
    return SCRIPT.format(verbs=" ".join(commands.choices), cases=cases)


def _words(parser: argparse.ArgumentParser) -> list[str]:
    """The options of a command, and the words that its arguments can be."""
    found: dict[str, None] = {}
    for action in parser._actions:
        found |= dict.fromkeys(one for one in action.option_strings if one.startswith("--"))
        found |= dict.fromkeys(map(str, action.choices or ()) if not action.option_strings else ())
    return [*found]

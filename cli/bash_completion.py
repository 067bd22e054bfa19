"""Completion in bash, which quotes names with spaces and completes shipped names next to files.

click's own function for bash inserts names as they are, and drops all names where files are completed too.
"""

from __future__ import annotations

from click.shell_completion import BashComplete


class QuotingBashComplete(BashComplete):
    """Shell function that leaves quoting to readline, which knows how the word on the command line is quoted."""

    source_template = r"""
%(complete_func)s() {
    local IFS=$'\n' type value
    COMPREPLY=()
    while IFS=, read -r type value; do
        case $type in
            plain) COMPREPLY+=("$value") ;;
            file) mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- "$value") ;;
            dir) mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "$value") ;;
        esac
    done < <(COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD=$COMP_CWORD %(complete_var)s=bash_complete "$1")
    compopt -o filenames
}
complete -o nosort -F %(complete_func)s %(prog_name)s
"""

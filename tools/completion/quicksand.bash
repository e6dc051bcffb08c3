# Completion of quicksand in bash. Commands and options are read from the program's own help.
_quicksand() {
  local program="${COMP_WORDS[0]}" word="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD - 1]}"
  local command="" n
  for ((n = 1; n < COMP_CWORD; ++n)); do
    [[ ${COMP_WORDS[n]} == -* ]] || { command="${COMP_WORDS[n]}"; break; }
  done
  program="${program/#\~/$HOME}"
  COMPREPLY=()
  local IFS=$'\n'
  case "$command:$before" in
    :*)
      COMPREPLY=($(compgen -W "$("$program" --help 2> /dev/null | sed -n 's/^  quicksand \([a-z]*\).*/\1/p')
--help
--version" -- "$word"))
      return ;;
    *:--set | *:--threads) return ;;
    *:--output)
      compopt -o filenames 2> /dev/null
      COMPREPLY=($(compgen -d -- "$word"))
      return ;;
    help:*)
      COMPREPLY=($(compgen -W "$("$program" --help 2> /dev/null | sed -n 's/^  quicksand \([a-z]*\).*/\1/p')" -- "$word"))
      return ;;
  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$("$program" "$command" --help 2> /dev/null | sed -n 's/^  \(--[a-z-]*\).*/\1/p')" -- "$word"))
    return
  fi
  compopt -o filenames 2> /dev/null
  case "$command" in
    run | check | show)
      COMPREPLY=($(compgen -f -X '!*.yaml' -- "$word") $(compgen -f -X '!*.yml' -- "$word") $(compgen -d -- "$word")) ;;
    info) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -F _quicksand quicksand

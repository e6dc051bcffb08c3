# Completion of quicksand in fish. Commands and options are read from the program's own help.
function __quicksand_commands
    quicksand --help 2>/dev/null | string replace -rf '^  quicksand ([a-z]+).*' '$1'
end
function __quicksand_options
    set -l words (commandline -opc)
    quicksand $words[2] --help 2>/dev/null | string replace -rf '^  (--[a-z-]+).*' '$1'
end
complete -c quicksand -f
complete -c quicksand -n 'test (count (commandline -opc)) -eq 1' -a '(__quicksand_commands) --help --version'
complete -c quicksand -n 'test (count (commandline -opc)) -gt 1; and string match -q -- "-*" (commandline -ct)' -a '(__quicksand_options)'
complete -c quicksand -n '__fish_seen_subcommand_from run check show' -k -a '(__fish_complete_suffix .yaml)'
complete -c quicksand -n '__fish_seen_subcommand_from info' -F
complete -c quicksand -n '__fish_seen_subcommand_from help' -a '(__quicksand_commands)'

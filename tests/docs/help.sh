#!/usr/bin/env bash
# Compares the help text in docs/options.md with what the program prints; --write puts the program's text there.
#   tests/docs/help.sh BUILD [--write]
set -euo pipefail
page="$(dirname "${BASH_SOURCE[0]}")/../../docs/options.md"
program="$1/samples/heliograph/heliograph"
expected=$(mktemp)
trap 'rm -f "$expected"' EXIT
{
    echo '<!-- help: the output of `heliograph render --help`; tests/docs/help.sh compares and renews it -->'
    echo '```'
    "$program" render --help | sed 's/[[:space:]]*$//'
    echo '```'
    echo '<!-- /help -->'
} >"$expected"
actual=$(sed -n '/^<!-- help:/,/^<!-- \/help -->/p' "$page")
if [ "${2:-}" = --write ]; then
    sed -i -e "/^<!-- help:/,/^<!-- \/help -->/{/^<!-- \/help -->/{r $expected
d};d}" "$page"
elif ! diff <(printf '%s\n' "$actual") "$expected"; then
    echo "docs/options.md differs from heliograph render --help; run tests/docs/help.sh $1 --write" >&2
    exit 1
fi

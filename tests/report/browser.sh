#!/usr/bin/env bash
# Opens a report in headless Chromium and looks at what a reader would stumble over:
#
#   tests/report/browser.sh REPORT.html [FOLDER]
#
# no message on the console, no sideways scrolling at 360 and 1440 px in light and dark, every figure of the
# same width as its column, the three numbers and whether anything is wrong on the first screen (at 1440 px with the
# main figure), a PDF when printed, with everything that is folded. FOLDER keeps the screenshots and the PDF.
set -euo pipefail
report=$(realpath "$1")
keep=${2:-$(mktemp -d)}
mkdir -p "$keep"
keep=$(realpath "$keep")
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome)

fail() {
    echo "FAILED: $*" >&2
    exit 1
}

# Options that let it run as root, without a display, and write nothing outside of its profile.
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
browse() {
    timeout 120 "$chromium" --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage --hide-scrollbars \
        --user-data-dir="$profile" --enable-logging=stderr --v=0 "$@"
}

# The page with a script at its end that says how wide things are, in a frame of the wanted width (a
# window has a least one).
probe="$profile/probe.html"
sed 's|</body>|<script>\
const root = document.documentElement;\
const wide = [...document.querySelectorAll("main *")]\
    .filter((one) => !one.closest("svg, .wide, pre") \&\& one.getBoundingClientRect().right > innerWidth + 1);\
const figures = [...document.querySelectorAll("svg.plot")].map((one) => one.getBoundingClientRect());\
const small = figures.filter((box) => box.width < 0.8 * Math.min(innerWidth, 480) \|\| box.height < 60);\
const lowest = (what) => Math.max(0, ...[...document.querySelectorAll(what)].map((one) => Math.ceil(one.getBoundingClientRect().bottom)));\
const first = [document.querySelectorAll("\#answer-0 .value").length, lowest("\#answer-0 .number, \#answer-0 .health"), lowest("\#answer-0 figure")];\
const cut = [...document.querySelectorAll(".facts td:last-child")].filter((one) => one.checkVisibility({ contentVisibilityAuto: true }) \&\& one.getBoundingClientRect().width < 120);\
const shut = [...document.querySelectorAll("details > :not(summary)")].filter((one) => \!one.checkVisibility({ contentVisibilityAuto: true }) \|\| one.getBoundingClientRect().height === 0);\
parent.postMessage(["PROBE", innerWidth, root.scrollWidth, wide.length, figures.length, small.length, ...first, shut.length, cut.length, "END"].join(" "), "*");\
</script></body>|' "$report" >"$probe"
framed() {
    cat >"$profile/frame.html" <<END
<!DOCTYPE html><title></title><iframe src="probe.html" style="width:$1px;height:900px;border:0"></iframe>
<script>addEventListener("message", (event) => { document.title = event.data; });</script>
END
}

# What the page says of itself at a width.
measure() {
    framed "$1"
    browse --window-size=1600,1000 --virtual-time-budget=5000 --dump-dom "file://$profile/frame.html" \
        >"$profile/dom" 2>"$profile/log"
    found=$(grep -o 'PROBE [0-9 ]* END' "$profile/dom" | head -n 1 || true)
}

for width in 360 1440; do
    measure $width
    read -r _ inner scroll wide figures small values numbers figure shut cut _ <<<"$found"
    [ "${inner:-0}" -eq $width ] || fail "a frame of ${inner:-unknown} instead of $width px"
    [ "$scroll" -le $width ] || fail "the page is $scroll px wide at a width of $width px"
    [ "$wide" -eq 0 ] || fail "$wide elements reach out of a width of $width px"
    [ "$figures" -gt 0 ] || fail "no figure is shown"
    [ "$small" -eq 0 ] || fail "$small figures are too small to read at $width px"
    [ "$values" -eq 3 ] || fail "$values large numbers instead of 3"
    [ "$numbers" -le 800 ] || fail "at $width px the three numbers and what is wrong reach down to $numbers px"
    [ $width -lt 1440 ] || [ "$figure" -le 900 ] || fail "at $width px the main figure reaches down to $figure px"
    [ "$cut" -eq 0 ] || fail "$cut facts are squeezed at $width px"
    [ "$shut" -gt 0 ] || fail "nothing is folded"
    browse --window-size=$width,7000 --screenshot="$keep/$width.png" "file://$report" >/dev/null 2>"$profile/log"
    ! grep CONSOLE "$profile/log" || fail "the console has something to say at $width px"
    echo "$width px: $figures figures, nothing beside the page, console silent"
done
browse --window-size=1440,7000 --blink-settings=preferredColorScheme=0 --screenshot="$keep/dark.png" "file://$report" \
    >/dev/null 2>"$profile/log"
! grep CONSOLE "$profile/log" || fail "the console has something to say in dark"
! cmp -s "$keep/dark.png" "$keep/1440.png" || fail "dark looks like light"

# On paper nothing can be unfolded: the style of print, on the screen.
sed -i 's|@media print|@media all|' "$probe"
measure 800
read -r _ _ _ _ _ _ _ _ _ shut _ <<<"$found"
[ "${shut:-1}" -eq 0 ] || fail "${shut:-all} folded parts stay folded in print"
browse --no-pdf-header-footer --print-to-pdf="$keep/report.pdf" "file://$report" >/dev/null 2>&1
[ "$(head -c 5 "$keep/report.pdf")" = "%PDF-" ] || fail "no PDF"
pages=$(grep -a -c '/Type */Page\b' "$keep/report.pdf" || true)
[ "$pages" -gt 1 ] || fail "the PDF has $pages pages"
echo "PDF: $pages pages"

# SPDX-License-Identifier: MIT
# SIGINT, SIGTERM and SIGHUP save the picture so far and print its samples.
take box
# Succeeds when the process has used 20 ticks of processor time: it renders.
renders()
{
    [ "$(awk '{ sub(/.*\) /, ""); print $12 + $13 }' "/proc/$1/stat")" -ge 20 ]
}
# Runs glim as process $(cat pid), in the foreground, since programs in the
# background ignore SIGINT.
glim_with_pid()
{
    sh -c 'echo $$ >pid.new; mv pid.new pid; exec glim "$@"' glim "$@" 2>err
}
# Waits until that process renders and sends it the signals.
send_when_it_renders()
{
    until [ -e pid ]; do
        sleep 0.02
    done
    until renders "$(cat pid)"; do
        [ -d "/proc/$(cat pid)" ] || break
        sleep 0.02
    done
    kill -s "$1" "$(cat pid)" || echo "SIG$1 came too late"
    shift
    for signal in "$@"; do # it may have ended by then
        kill -s "$signal" "$(cat pid)"
    done
    rm pid
} 2>/dev/null
stop()
{
    echo old >out.png
    send_when_it_renders "$1" &
    glim_with_pid -b -w 40 -h 30 -s 1000000000 -o out.png --stats run.json \
        box.obj
    echo "exit $?"
    wait
    sed 's/ at [0-9]* of/ at N of/' err | untimed
    kind out.png
    grep stopped run.json
    awk '/"spp"/ { print ($2 + 0 > 0 ? "some samples" : "no sample") }' run.json
    rm out.png run.json
}
stop INT
stop TERM
stop HUP
# more signals do not disturb saving
send_when_it_renders TERM TERM TERM &
glim_with_pid -b -w 900 -h 600 -s 1000000000 -o more.png box.obj
echo "exit $?"
wait
sed 's/ at [0-9]* of/ at N of/' err | untimed
kind more.png
# a program started with the signal ignored continues
(
    trap '' HUP
    send_when_it_renders HUP &
    glim_with_pid -b -w 80 -h 60 -s 1500 -o hup.png box.obj
    echo "exit $?"
    wait
)
untimed err
ls -A

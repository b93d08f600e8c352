# SPDX-License-Identifier: MIT
# A first signal ends the program within a second, whatever it waits for.
take box
mkfifo out err
mkdir bin
PATH=$PWD/bin:$PATH

# Runs glim in the foreground, since programs in the background ignore SIGINT.
# Prints its status, whether it ended within a second of the signal, and whether
# the file is there. The signal comes while it waits.
stop()
{
    signal=$1
    shift
    rm -f pid
    {
        until [ -e pid ]; do
            sleep 0.02
        done
        sleep 0.8
        date +%s%N >sent
        kill -s "$signal" "$(cat pid)"
    } 2>/dev/null &
    sh -c 'echo $$ >pid.new; mv pid.new pid; exec glim "$@"' glim "$@"
    status=$?
    ms=$((($(date +%s%N) - $(cat sent)) / 1000000))
    [ $ms -lt 1000 ] && ms=within
    wait $!
    echo "$signal: exit $status $ms" >&3
}
exec 3>&1
b="-b -s 1 -t 1"
sleep 60 <out &
reader=$!
# nothing reads the picture
stop INT $b -w 200 -h 200 -o - box.obj >out 2>text
cat text
stop TERM $b --ansi 300x200 box.obj >out 2>text
cat text
# nothing reads the messages
sleep 60 <err &
others=$!
yes | head -c 65536 >err
stop TERM $b -w 64 -h 64 -o err.png box.obj 2>err
kill $reader $others

# ffmpeg reads nothing, and has begun a file
echo old >a.mp4
cat >bin/ffmpeg <<'SH'
#!/bin/sh
echo $$ >ffmpeg.pid
for file in "$@"; do :; done
echo partial >"${file#file:}"
exec sleep 60
SH
chmod +x bin/ffmpeg
for signal in INT TERM HUP; do
    stop $signal $b -w 200 -h 200 --turntable 6 -o a.mp4 box.obj 2>text
    tail -n 1 text
    grep -qs 'State:.[^Z]' "/proc/$(cat ffmpeg.pid)/status" &&
        echo "ffmpeg goes on"
    ls a.mp4 2>/dev/null
done
# it takes all pictures and does not end
cat >bin/ffmpeg <<'SH'
#!/bin/sh
cat >/dev/null
exec sleep 60
SH
echo old >a.mp4
stop TERM $b -w 200 -h 200 --turntable 6 -o a.mp4 box.obj 2>text
tail -n 1 text
cat a.mp4
# one that fails leaves nothing either
cat >bin/ffmpeg <<'SH'
#!/bin/sh
for file in "$@"; do :; done
head -c 1000 >"${file#file:}"
exit 1
SH
run $b -w 200 -h 200 --turntable 6 -o a.mp4 box.obj | tail -n 1
ls

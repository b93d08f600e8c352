# SPDX-License-Identifier: MIT
# SIGINT, SIGTERM and SIGHUP save the picture so far and say how far it is.
take box
stop()
{
    echo old >out.png
    timeout --preserve-status -s "$1" 1 glim -b -w 40 -h 30 -s 1000000000 \
        -o out.png --stats run.json box.obj 2>err
    echo "exit $?"
    sed 's/ at [0-9]* of/ at N of/' err
    kind out.png
    grep stopped run.json
    awk '/"spp"/ { print ($2 + 0 > 0 ? "some samples" : "no sample") }' run.json
    rm out.png run.json
}
stop INT
stop TERM
stop HUP
# more signals do not disturb the saving
glim -b -w 900 -h 600 -s 1000000000 -o more.png box.obj 2>err &
sleep 0.5
for i in 1 2 3 4 5; do
    kill -TERM $! 2>/dev/null
    sleep 0.01
done
wait $!
echo "exit $?"
sed 's/ at [0-9]* of/ at N of/' err
kind more.png
# a job that was told to ignore the signal goes on
(
    trap '' HUP
    glim -b -w 80 -h 60 -s 300 -o hup.png box.obj 2>err &
    sleep 0.2
    kill -HUP $!
    wait $!
    echo "exit $?"
)
sed 's/, [0-9.]* s$/, T s/' err
ls -A

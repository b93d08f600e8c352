# SPDX-License-Identifier: MIT
# Two renders do not write one film: the second is refused, until the first
# has ended, by whatever end.
take box
b="-b -w 24 -h 18"
mkdir below
ln -s ../two.film below/link.film
begin()
{
    glim $b -s 1000000000 --checkpoint two.film --checkpoint-interval 1 \
        -o a.png box.obj 2>/dev/null &
    until [ -e two.film ]; do
        sleep 0.05
    done
}
begin
run $b -s 4 --seed 1 --checkpoint two.film -o b.png box.obj
run $b -s 4 --seed 1 --checkpoint below/link.film -o b.png box.obj
run $b -s 4 --seed 1 --film two.film -o b.png box.obj
ls
run_untimed $b -s 4 --checkpoint one.film -o b.png box.obj
kill -KILL $!
wait $! 2>/dev/null
run_untimed $b -s 4 --checkpoint two.film --film ./two.film -o b.png box.obj
rm two.film
begin
kill -TERM $!
wait $!
run_untimed $b -s 4 --checkpoint two.film -o b.png box.obj

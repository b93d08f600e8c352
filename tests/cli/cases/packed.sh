# SPDX-License-Identifier: MIT
# Scenes packed by gzip and from standard input have the same picture as the file.
take plain box
b="-b -w 8 -h 8 -s 2"
run_untimed $b -o plain.pfm box.obj
gzip -c box.obj >packed.obj.gz
cp box.view packed.view
run_untimed $b packed.obj.gz
run_untimed $b -o packed.pfm packed.obj.gz
cmp plain.pfm packed.pfm
# renders standard input
piped()
{
    glim $b -c box.view "$@" - 2>/dev/null
    echo "exit $?"
}
# several members, and bytes behind them
{
    head -c 100 box.obj | gzip
    tail -c +101 box.obj | gzip
    echo trailing
} >parts.obj
run_untimed $b -c box.view -o packed.pfm parts.obj
cmp plain.pfm packed.pfm
# standard input, packed or not
piped -o packed.pfm <box.obj
cmp plain.pfm packed.pfm
cat packed.obj.gz | piped
kind scene.png
# broken files, and standard input where it cannot be read
head -c 100 packed.obj.gz >short.obj
run $b short.obj
printf '\037\213no' >false.obj
run $b false.obj
run $b - </dev/null
run -
run -f -
run curve plain.pfm -

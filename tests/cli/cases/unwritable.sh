# SPDX-License-Identifier: MIT
# A folder without write permission is reported before the render.
[ "$(id -u)" != 0 ] || skip "the superuser may write everywhere"
mkdir shut
chmod a-w shut
take box
run -b -s 1000000000 -o shut/out.png box.obj
cd shut
run -b -s 1000000000 ../box.obj

# SPDX-License-Identifier: MIT
# A folder without permission is said before the render begins.
[ "$(id -u)" != 0 ] || skip "the superuser may write everywhere"
mkdir shut
chmod a-w shut
take box
run -b -s 1000000000 -o shut/out.png box.obj
cd shut
run -b -s 1000000000 ../box.obj

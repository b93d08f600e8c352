# SPDX-License-Identifier: MIT
# Standard streams that are closed at the start cause no failure.
take box
glim -b -w 8 -h 4 -s 1 -o a.png box.obj 2>/dev/null
glim -b -w 8 -h 4 -s 1 -o b.png box.obj <&- >&- 2>&-
echo "exit $?"
same a.png b.png
glim -b -w 8 -h 4 -s 0 box.obj 2>&-
echo "exit $?"

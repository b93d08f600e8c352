# SPDX-License-Identifier: MIT
# Errors in the configuration file, and what overrides it.
take box
XDG_CONFIG_HOME=$PWD
export XDG_CONFIG_HOME
mkdir glim
try() # the file's text
{
    printf '%b' "$1" >glim/config
    run -b -w 8 -s 1 -o box.png box.obj 2>&1 |
        sed "s|$PWD|.|" | untimed
}
try ''
try '# mine\n\nkey orbit x F1 ^B # three\noption color 256\noption phoe-keys\n'
try 'option t 1\noption t x\n'
try 'option backend gpu\n'
try 'option color\n'
try 'option color 16 mono\n'
try 'option phoe-keys yes\n'
try 'option seed 3\n'
try 'option\n'
try 'key\n'
try 'key fly x\n'
try 'key orbit\n'
try 'key orbit none x\n'
try 'key orbit none\n'
try 'key orbit xy\n'
try 'key orbit a b c d\n'
try '\nkey orbit a b c d e\n'
try 'keys orbit a\n'
# --help works in spite of an error in the file
glim --help | head -n 1
glim --version | sed -n 's/[0-9.]*$/N/; 1p'
# a relative XDG_CONFIG_HOME is ignored; the folder at home is used
mkdir -p home/.config/glim
echo wrong >home/.config/glim/config
echo fine >glim/config
HOME=$PWD/home XDG_CONFIG_HOME=. glim -b box.obj 2>&1 | sed "s|$PWD|.|"
HOME= XDG_CONFIG_HOME= run -b -w 8 -s 1 -o box.png box.obj |
    untimed
# a folder in place of the file
rm glim/config
mkdir glim/config
run -b box.obj | sed "s|$PWD|.|"
# the command line overrides it: the missing device is not looked for
rmdir glim/config
echo 'option backend opencl' >glim/config
run_untimed -b --backend cpu -w 8 -s 1 -o box.png box.obj

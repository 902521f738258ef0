#include "app/cli.h"

int main(int argc, char** argv) {
    return serosa::app::runCommandLine(argc, argv);
}

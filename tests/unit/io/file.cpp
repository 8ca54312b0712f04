// Files that are written whole or not at all, PNG, and tables.
#include <insonify/io/file.hpp>
#include <insonify/io/manifest.hpp>
#include <insonify/io/netpbm.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <thread>

#if defined(__unix__)
#include <csignal>

#include <sys/resource.h>
#include <sys/stat.h>
#endif

#include "../../catch.hpp"
#include "../../scratch_folder.hpp"

#if __has_include(<stb_image_write.h>) || __has_include(<stb/stb_image_write.h>)
#define INSONIFY_TEST_PNG
// In front of png.hpp, as a program in one file has it.
#define STB_IMAGE_WRITE_IMPLEMENTATION
#if __has_include(<stb_image_write.h>)
#include <stb_image_write.h>
#else
#include <stb/stb_image_write.h>
#endif
#include <insonify/io/png.hpp>
#endif
#if defined(INSONIFY_TEST_PNG) && (__has_include(<stb_image.h>) || __has_include(<stb/stb_image.h>))
#define INSONIFY_TEST_PNG_PIXELS
#define STB_IMAGE_IMPLEMENTATION
#if __has_include(<stb_image.h>)
#include <stb_image.h>
#else
#include <stb/stb_image.h>
#endif
#endif

namespace in = insonify;
namespace fs = std::filesystem;
using namespace std::string_literals;

TEST_CASE("write_file() writes any bytes unchanged") {
    const scratch_folder folder;
    const std::string path = folder / "bytes";
    for (const std::size_t size : {0u, 1u, 65535u, 65536u, 65537u, 300000u}) {
        std::string bytes(size, '\0');
        for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 7 + i / 251);
        in::write_file(path, bytes);
        CHECK(in::read_file(path) == bytes);
    }
    CHECK(folder.names() == std::set<std::string>{"bytes"});
}

TEST_CASE("A file that is not committed leaves the old one and no temporary") {
    const scratch_folder folder;
    const std::string path = folder / "table.csv";
    in::write_file(path, "old");
    {
        in::replacement_file file(path);
        file.write("half of the ne", 14);
        CHECK(in::read_file(path) == "old");
        CHECK(folder.names().size() == 2);
    }
    CHECK(in::read_file(path) == "old");
    CHECK(folder.names() == std::set<std::string>{"table.csv"});
}

TEST_CASE("A write that fails says why and leaves nothing behind") {
    const scratch_folder folder;
    CHECK_THROWS_WITH(in::write_file(folder / "no/such/folder", "x"),
                      ContainsSubstring("no/such/folder") && ContainsSubstring("can't open for writing"));
    // A folder can't be replaced by a file.
    fs::create_directory(folder / "taken");
    std::ofstream(folder / "taken/inside") << "here";
    CHECK_THROWS_AS(in::write_file(folder / "taken", "x"), in::io_error);
    CHECK(folder.names() == std::set<std::string>{"taken"});
    CHECK(in::read_file(folder / "taken/inside") == "here");

    CHECK_THROWS_WITH(in::read_file(folder / "absent"), ContainsSubstring("absent") && ContainsSubstring("can't open"));
    CHECK_THROWS_AS(in::read_file(folder.path.string()), in::io_error);
}

#if defined(__unix__)
TEST_CASE("Pipes, folders and links to them are not replaced by files") {
    const scratch_folder folder;
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    fs::create_symlink("pipe", folder.path / "link");
    fs::create_directory_symlink(".", folder.path / "here");
    for (const char* name : {"pipe", "link", "here"})
        CHECK_THROWS_WITH(in::write_file(folder / name, "text"), ContainsSubstring("not a regular file"));
    CHECK(fs::is_fifo(folder.path / "pipe"));
    CHECK(fs::is_symlink(folder.path / "link"));
    CHECK_THROWS_WITH(in::write_file(folder.path.string(), "text"), ContainsSubstring("not a regular file"));
    CHECK_THROWS_WITH(in::write_file(folder / "a" + '\0' + "b", "text"),
                      ContainsSubstring("its name contains a null byte"));
    CHECK_THROWS_WITH(in::write_file("", "text"),
                      ContainsSubstring("a file with an empty name: can't open for writing"));
    CHECK_THROWS_WITH(in::read_file(""), ContainsSubstring("a file with an empty name: can't open for reading"));
    CHECK(folder.names() == std::set<std::string>{"here", "link", "pipe"});
}

TEST_CASE("A symbolic or hard link is replaced by the new file, and the file that it names stays") {
    const scratch_folder folder;
    in::write_file(folder / "old", "old");
    fs::create_symlink("old", folder.path / "symbolic");
    fs::create_hard_link(folder.path / "old", folder.path / "hard");
    for (const char* name : {"symbolic", "hard"}) {
        in::write_file(folder / name, "new");
        CHECK(fs::symlink_status(folder.path / name).type() == fs::file_type::regular);
        CHECK(in::read_file(folder / name) == "new");
        CHECK(in::read_file(folder / "old") == "old");
    }
}

TEST_CASE("A full disk loses the new file, not the old one") {
    const scratch_folder folder;
    const std::string path = folder / "image.pgm";
    in::write_file(path, "old");

    // Stands in for a full disk: files may not grow beyond 4096 bytes.
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
    rlimit limited = before;
    limited.rlim_cur = 4096;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &limited) == 0);
    std::string messages;
    for (const std::size_t size : {std::size_t{5000}, std::size_t{5000000}}) {
        try {
            in::write_file(path, std::string(size, 'x'));
        } catch (const in::io_error& error) {
            messages += error.what() + std::string(";");
        }
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);

    CHECK(messages == path + ": can't write: File too large;" + path + ": can't write: File too large;");
    CHECK(in::read_file(path) == "old");
    CHECK(folder.names() == std::set<std::string>{"image.pgm"});
}
#endif

TEST_CASE("Concurrent writers of one path do not mix their bytes") {
    const scratch_folder folder;
    const std::string path = folder / "shared";
    std::vector<std::thread> writers;
    for (int i = 0; i < 4; ++i) {
        writers.emplace_back([&path, i] {
            for (int n = 0; n < 10; ++n) in::write_file(path, std::string(100000, static_cast<char>('a' + i)));
        });
    }
    for (std::thread& writer : writers) writer.join();
    const std::string bytes = in::read_file(path);
    CHECK(bytes == std::string(100000, bytes.at(0)));
    CHECK(folder.names() == std::set<std::string>{"shared"});
}

#if defined(__unix__)
TEST_CASE("write_file() takes names of 255 bytes and no longer ones") {
    const scratch_folder scratch;
    for (const std::string& name : {std::string(255, 'n'), std::string(100, 'a') + '\\' + std::string(154, 'b')}) {
        in::write_file(scratch / name, "text");
        CHECK(in::read_file(scratch / name) == "text");
    }
    CHECK_THROWS_WITH(in::write_file(scratch / std::string(256, 'n'), "text"),
                      ContainsSubstring("can't replace: File name too long"));
    CHECK(scratch.names().size() == 2);
}
#endif

TEST_CASE("A temporary name in use is skipped") {
    const scratch_folder folder;
    in::write_file(folder / "image.pgm.tmp0", "left by a crash");
    in::write_file(folder / "image.pgm", "new");
    CHECK(in::read_file(folder / "image.pgm") == "new");
    CHECK(in::read_file(folder / "image.pgm.tmp0") == "left by a crash");
    CHECK(folder.names().size() == 2);
}

TEST_CASE("An image, whole or a part, is the same after writing and reading") {
    const scratch_folder folder;
    const std::string path = folder / "image.pgm";
    const in::image<std::uint8_t> gray{{0, 10, 255}, {'#', ' ', '\n'}};
    in::write_netpbm(path, gray);
    CHECK(in::read_netpbm<std::uint8_t>(path) == gray);
    in::image<std::uint8_t> changing = gray;
    in::write_netpbm(path, changing.view().part(1, 0, 2, 2));
    CHECK(in::read_netpbm<std::uint8_t>(path) == in::image<std::uint8_t>{{10, 255}, {' ', '\n'}});
    CHECK_THROWS_WITH(in::read_netpbm<in::rgb8>(path), ContainsSubstring(path) && ContainsSubstring("a gray image"));
}

TEST_CASE("A table quotes fields as RFC 4180 requires") {
    in::csv_table table{"name", "note"};
    table.add("plain", "two words");
    table.add("comma, here", "she said \"ping\"");
    table.add("line\nbreak", std::string("carriage\rreturn"));
    table.add(std::string_view(), " edges ");
    CHECK(table.text() ==
          "name,note\r\n"
          "plain,two words\r\n"
          "\"comma, here\",\"she said \"\"ping\"\"\"\r\n"
          "\"line\nbreak\",\"carriage\rreturn\"\r\n"
          ", edges \r\n");
}

TEST_CASE("A table writes numbers so that they read back as the same") {
    in::csv_table table{"i", "f", "d", "b", "u"};
    table.add(-12, 0.1f, 1.0 / 3, true, std::uint8_t{200});
    table.add(std::uint64_t{18446744073709551615u}, 1e-42f, 1e300, false, std::uint16_t{65535});
    CHECK(table.text() ==
          "i,f,d,b,u\r\n-12,0.1,0.3333333333333333,true,200\r\n"
          "18446744073709551615,1e-42,1e+300,false,65535\r\n");
}

TEST_CASE("A table has a cell for every column and is written whole") {
    const scratch_folder folder;
    in::csv_table table{"only"};
    table.add("");
    CHECK(table.text() == "only\r\n\"\"\r\n");
    CHECK_THROWS_WITH(table.add(1, 2),
                      ContainsSubstring("cells in a row is 2") && ContainsSubstring("1, one for each column"));
    CHECK_THROWS_AS(table.add(), in::invalid_input);
    CHECK_THROWS_AS(in::csv_table({}), in::invalid_input);
    table.write(folder / "manifest.csv");
    CHECK(in::read_file(folder / "manifest.csv") == "only\r\n\"\"\r\n");
}

#if defined(INSONIFY_TEST_PNG)
TEST_CASE("A PNG that can't be written throws and leaves nothing behind") {
    const scratch_folder folder;
    CHECK_THROWS_AS(in::write_png(folder / "empty.png", in::image<float>()), in::invalid_input);
    CHECK_THROWS_AS(in::write_png(folder / "no/folder.png", in::image<float>(2, 2)), in::io_error);
    CHECK(folder.names().empty());
}
#endif

#if defined(INSONIFY_TEST_PNG_PIXELS)
TEST_CASE("A PNG holds the pixels, of a part of an image too") {
    const scratch_folder folder;
    const std::string path = folder / "image.png";
    const auto read = [&path](int channels) {
        int width = 0, height = 0, found = 0;
        stbi_uc* const pixels = stbi_load(path.c_str(), &width, &height, &found, 0);
        REQUIRE(pixels != nullptr);
        CHECK(found == channels);
        std::vector<int> values{width, height};
        for (int i = 0; i < width * height * found; ++i) values.push_back(pixels[i]);
        stbi_image_free(pixels);
        return values;
    };
    in::write_png(path, in::image<std::uint8_t>{{0, 1, 2}, {253, 254, 255}});
    CHECK(read(1) == std::vector<int>{3, 2, 0, 1, 2, 253, 254, 255});
    in::write_png(path, in::image<in::rgb8>{{{1, 2, 3}, {4, 5, 6}}});
    CHECK(read(3) == std::vector<int>{2, 1, 1, 2, 3, 4, 5, 6});
    in::write_png(path, in::image<float>{{0, 0.5f}, {1, 7}});
    CHECK(read(1) == std::vector<int>{2, 2, 0, 128, 255, 255});
    const in::image<in::rgb8> whole{{{1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, {{4, 4, 4}, {5, 5, 5}, {6, 6, 6}}};
    in::write_png(path, whole.view().part(1, 0, 1, 2));
    CHECK(read(3) == std::vector<int>{1, 2, 2, 2, 2, 5, 5, 5});
}

TEST_CASE("A PNG holds a narrow part of an image of more than 2^31 bytes") {
    const scratch_folder folder;
    const int height = 33000, stride = 65536;
    const std::size_t bytes = std::size_t{33000} * 65536;
    const std::unique_ptr<std::uint8_t, decltype(&std::free)> memory(static_cast<std::uint8_t*>(std::calloc(bytes, 1)),
                                                                     &std::free);
    if (memory == nullptr) {
        SUCCEED("not enough memory");
        return;
    }
    memory.get()[bytes - stride + 2] = 200;
    in::write_png(folder / "image.png", in::image_view<const std::uint8_t>(memory.get(), 3, height, stride));
    int width = 0, rows = 0, channels = 0;
    stbi_uc* const pixels = stbi_load((folder / "image.png").c_str(), &width, &rows, &channels, 0);
    REQUIRE(pixels != nullptr);
    CHECK((width == 3 && rows == height && channels == 1));
    CHECK(pixels[3 * height - 1] == 200);
    stbi_image_free(pixels);
}
#endif

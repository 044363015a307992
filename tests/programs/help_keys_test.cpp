// Settings that help texts and documents name are settings that there are.

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "programs/process.h"
#include "support/content.h"

namespace tyndall::test {
namespace {
namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Every key stands alone on its line.
std::set<std::string> settings() {
    std::set<std::string> keys;
    std::istringstream lines(tyndall({"info", "--settings"}).out);
    for (std::string line; std::getline(lines, line);)
        if (std::regex_match(line, std::regex("[a-zA-Z0-9]+(\\.[a-zA-Z0-9]+)+"))) keys.insert(line);
    return keys;
}

std::set<std::string> found(const std::string& text, const std::string& pattern) {
    const std::regex regex(pattern);
    std::set<std::string> words;
    for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
        words.insert((*it)[1]);
    return words;
}

/// Texts by where they come from.
std::vector<std::pair<std::string, std::string>> helpTexts() {
    std::vector<std::pair<std::string, std::string>> texts = {{"--help", tyndall({"--help"}).out}};
    for (const char* command : {"capture", "compare", "graph", "info", "reference"})
        texts.emplace_back(std::string(command) + " --help", tyndall({command, "--help"}).out);
    if (const fs::path editor = binDir() / "tyndall-editor"; fs::exists(editor))
        texts.emplace_back("tyndall-editor --help", run({editor.string(), "--help"}).out);
    return texts;
}

std::vector<std::pair<std::string, std::string>> documents() {
    std::vector<std::pair<std::string, std::string>> texts;
    for (const char* name : {"README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"})
        texts.emplace_back(name, contentOf(sourceDir() / name));
    for (const auto& entry : fs::recursive_directory_iterator(sourceDir() / "docs"))
        if (entry.path().extension() == ".md")
            texts.emplace_back(fs::relative(entry.path(), sourceDir()).string(),
                               contentOf(entry.path()));
    return texts;
}

TEST(SettingsByName, WhatSetAssignsInHelpAndDocumentsIsThere) {
    const std::set<std::string> keys = settings();
    ASSERT_GT(keys.size(), 50u);
    auto texts = helpTexts();
    const auto pages = documents();
    texts.insert(texts.end(), pages.begin(), pages.end());
    size_t seen = 0;
    for (const auto& [place, text] : texts)
        for (const std::string& key : found(text, "--set[ =]'?([a-z][A-Za-z0-9.]*)=")) {
            EXPECT_TRUE(keys.count(key)) << place << " sets " << key;
            ++seen;
        }
    EXPECT_GT(seen, 3u) << "the pattern finds nothing any more";
}

/// Names of passes and of their images look like keys: they are quoted in the sources.
std::string sources() {
    std::string text;
    for (const char* folder : {"engine", "plugins"})
        for (const auto& entry : fs::recursive_directory_iterator(sourceDir() / folder))
            if (entry.path().extension() == ".cpp") text += contentOf(entry.path());
    return text;
}

TEST(SettingsByName, KeysInHelpAndDocumentsAreThere) {
    const std::set<std::string> keys = settings();
    std::set<std::string> groups; // "gi", "gi.vpl", "media" …
    for (const std::string& key : keys)
        for (size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', dot + 1))
            groups.insert(key.substr(0, dot));
    const auto ofAGroup = [&](const std::string& word) {
        return groups.count(word.substr(0, word.rfind('.'))) > 0;
    };
    const std::string word = "[a-z][A-Za-z]*(?:\\.[A-Za-z]+)+";
    for (const auto& [place, text] : helpTexts())
        for (const std::string& key : found(text, "(?:^|[ '`])(" + word + ")"))
            EXPECT_TRUE(!ofAGroup(key) || keys.count(key)) << place << " names " << key;

    const std::string code = sources();
    size_t seen = 0;
    for (const auto& [place, text] : documents())
        for (const std::string& key : found(text, "`(" + word + ")[0-9]*(?:=[^`]*)?`")) {
            if (!ofAGroup(key)) continue;
            EXPECT_TRUE(keys.count(key) || code.find('"' + key) != std::string::npos)
                << place << " names " << key;
            ++seen;
        }
    EXPECT_GT(seen, 20u) << "the pattern finds nothing any more";
}

} // namespace
} // namespace tyndall::test

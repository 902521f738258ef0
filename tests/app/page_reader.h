#pragma once
// Reads a report's page strictly, as XML would: every tag closed in order, every attribute quoted and once,
// no '<' or '&' that is not markup. The style sheet is text like any other.

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace serosa::app {

struct Element {
    std::string name;
    std::map<std::string, std::string> attributes;
    std::string text;                 // of itself and all within
    std::size_t begin = 0, end = 0;   // bytes of the page, tags included
    std::vector<std::size_t> parents; // outermost first

    std::string attribute(const std::string& key) const {
        const auto found = attributes.find(key);
        return found == attributes.end() ? "" : found->second;
    }
};

class PageReader {
public:
    explicit PageReader(std::string_view page) : page_(page) { read(); }

    /// What is not well-formed, with its byte; empty: all is.
    const std::string& error() const { return error_; }
    const std::vector<Element>& elements() const { return elements_; }

    std::vector<const Element*> all(const std::string& name, const std::string& cssClass = "",
                                    const Element* within = nullptr) const {
        std::vector<const Element*> found;
        for (const Element& element : elements_)
            if (element.name == name && (cssClass.empty() || hasClass(element, cssClass)) &&
                (!within || (element.begin > within->begin && element.end < within->end)))
                found.push_back(&element);
        return found;
    }
    const Element* byId(const std::string& id) const {
        for (const Element& element : elements_)
            if (element.attribute("id") == id)
                return &element;
        return nullptr;
    }
    static bool hasClass(const Element& element, const std::string& name) {
        return (" " + element.attribute("class") + " ").find(" " + name + " ") != std::string::npos;
    }

private:
    static bool isName(char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    }
    void fail(const std::string& what) {
        if (error_.empty())
            error_ = what + " at byte " + std::to_string(at_);
    }
    bool skip(std::string_view text) {
        if (page_.substr(at_, text.size()) != text)
            return false;
        at_ += text.size();
        return true;
    }
    std::string name() {
        const std::size_t from = at_;
        while (at_ < page_.size() && isName(page_[at_]))
            ++at_;
        if (at_ == from)
            fail("a name is missing");
        return std::string(page_.substr(from, at_ - from));
    }
    /// Up to `end`, entities resolved.
    std::string textUntil(char end) {
        static const std::array<std::pair<std::string_view, char>, 5> entities = {
            {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&#39;", '\''}}};
        std::string text;
        while (at_ < page_.size() && page_[at_] != end && error_.empty()) {
            if (page_[at_] == '<')
                fail("a stray '<'");
            if (page_[at_] != '&') {
                text += page_[at_++];
                continue;
            }
            const auto entity = std::find_if(entities.begin(), entities.end(),
                                             [this](const auto& one) { return skip(one.first); });
            if (entity == entities.end())
                fail("a stray '&'");
            else
                text += entity->second;
        }
        return text;
    }
    void openTag() {
        Element element;
        element.begin = at_ - 1;
        element.name = name();
        element.parents = stack_;
        while (error_.empty() && skip(" ")) {
            const std::string key = name();
            if (!skip("=\""))
                fail("an attribute without a quoted value");
            if (!element.attributes.emplace(key, textUntil('"')).second)
                fail("attribute " + key + " twice");
            if (!skip("\""))
                fail("an attribute without an end");
        }
        const bool whole = skip("/");
        if (!skip(">"))
            fail("a tag without an end");
        element.end = at_;
        elements_.push_back(std::move(element));
        if (!whole)
            stack_.push_back(elements_.size() - 1);
    }
    void closeTag() {
        const std::string closed = name();
        if (!skip(">") || stack_.empty() || elements_[stack_.back()].name != closed)
            return fail("</" + closed + "> closes nothing");
        elements_[stack_.back()].end = at_;
        stack_.pop_back();
    }
    void read() {
        if (!skip("<!DOCTYPE html>"))
            fail("no <!DOCTYPE html>");
        while (at_ < page_.size() && error_.empty()) {
            if (page_[at_] == '<') {
                ++at_;
                skip("/") ? closeTag() : openTag();
                continue;
            }
            const std::string text = textUntil('<');
            for (const std::size_t parent : stack_)
                elements_[parent].text += text;
            if (stack_.empty() && text.find_first_not_of('\n') != std::string::npos)
                fail("text outside of the page");
        }
        if (!stack_.empty())
            fail("<" + elements_[stack_.back()].name + "> is not closed");
    }

    std::string_view page_;
    std::size_t at_ = 0;
    std::string error_;
    std::vector<Element> elements_;
    std::vector<std::size_t> stack_;
};

} // namespace serosa::app

#include "engine/scene/extras/schema.hpp"

#include <heliograph_extras_schema.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include <algorithm>

namespace helio::extras {
namespace {

using nlohmann::json;

const valijson::Schema& parsedSchema() {
    static const valijson::Schema* const parsed = [] {
        static valijson::Schema result;
        valijson::SchemaParser parser(valijson::SchemaParser::kDraft7);
        parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema()), result);
        return &result;
    }();
    return *parsed;
}

/** A step of valijson's paths, `["name"]` or `[3]`, as that of a JSON pointer, unescaped. */
std::string step(const std::string& context) {
    const std::size_t quote = context.find('"');
    if (quote == std::string::npos) return context.substr(1, context.size() - 2);
    return context.substr(quote + 1, context.rfind('"') - quote - 1);
}

const json& resolved(const json& part) {
    const auto reference = part.find("$ref");
    if (reference == part.end()) return part;
    return schema().at(json::json_pointer(reference->get<std::string>().substr(1)));
}

/** What the schema says of the place that steps lead to, or of the nearest above that it speaks of. */
std::string describe(const std::vector<std::string>& steps) {
    const json* at = &schema();
    std::string description;
    for (const std::string& name : steps) {
        const auto properties = at->find("properties");
        if (properties != at->end() && properties->contains(name)) {
            at = &resolved(properties->at(name));
        } else {
            break;  // inside an array, which describes its elements
        }
        description = at->value("description", description);
    }
    return description;
}

/** One line of printable text: a message may quote the file. */
std::string oneLine(const std::string& text) {
    std::string line;
    for (const char c : text.substr(0, 200)) line.push_back(c >= ' ' && c <= '~' ? c : '?');
    while (!line.empty() && line.back() == '.') line.pop_back();
    return line;
}

}  // namespace

const json& schema() {
    static const json parsed = json::parse(schemaText);
    return parsed;
}

std::optional<Fault> faultOf(const json& extras) {
    valijson::Validator validator;
    valijson::ValidationResults results;
    if (validator.validate(parsedSchema(), valijson::adapters::NlohmannJsonAdapter(extras), &results))
        return std::nullopt;
    // An object is at fault because of a member: the deepest place says most.
    const auto deepest = std::max_element(results.begin(), results.end(), [](const auto& a, const auto& b) {
        return a.context.size() < b.context.size();
    });
    if (deepest == results.end()) return Fault{"", "does not follow the schema", describe({})};
    Fault fault;
    std::vector<std::string> steps;
    for (std::size_t i = 1; i < deepest->context.size(); ++i) steps.push_back(step(deepest->context[i]));
    json::json_pointer pointer;
    for (const std::string& name : steps) pointer /= name;
    fault.pointer = oneLine(pointer.to_string());
    fault.fault = oneLine(deepest->description);
    fault.expected = describe(steps);
    return fault;
}

}  // namespace helio::extras

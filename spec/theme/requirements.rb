# SPDX-License-Identifier: BSD-2-Clause
# Shows the numbers of requirements: in the source they are anchors, which leave no trace in print.
require 'asciidoctor/extensions'

Asciidoctor::Extensions.register do
  include_processor do
    def self.numbered(text)
      text.gsub(/^((?:[*.]+ )?)\[\[(REQ-[A-Z]+-\d+)\]\](?=\S)/, '\1[[\2]][.req]#\2# ')
    end

    processor = self
    handles? { |target| target.start_with? 'clauses/' }
    process do |doc, reader, target, attributes|
      path = File.expand_path target, doc.attr('docdir')
      if File.file? path
        reader.push_include processor.numbered(File.read(path, encoding: 'utf-8')), path, target, 1, attributes
      elsif !attributes.key?('optional-option')
        raise "#{target} is missing"
      end
      reader
    end
  end
end
